//! Velocities at the end of a step that satisfy (P1) and (P4) of [`crate::contact`].

use crate::blocks::{Blocks, Triple};
use crate::contact::{Contact, Effort};
use crate::interior::{Interior, Survey, Tries};
use crate::order::Orders;

/// Solves steps of bodies whose pairs stay the same.
#[derive(Debug, Clone)]
pub struct Solver {
    matrix: Blocks,
    interior: Interior,
    bodies: usize,
}

impl Solver {
    /// For so many bodies, of which these pairs may touch.
    pub(crate) fn new(bodies: usize, pairs: &[(usize, usize)], orders: &Orders) -> Self {
        Solver { matrix: Blocks::new(bodies, pairs, orders), interior: Interior::default(), bodies }
    }

    /// Whether it is for no bodies.
    pub fn is_empty(&self) -> bool {
        self.bodies == 0
    }

    /// The matrix, for the slots of its pairs.
    pub fn matrix(&self) -> &Blocks {
        &self.matrix
    }

    /// How attempts fared in the steps before, on which it depends how the next are solved.
    pub(crate) fn tries(&self) -> Tries {
        self.interior.tries
    }

    /// Goes on as after those.
    pub(crate) fn go_on(&mut self, tries: Tries) {
        self.interior.tries = tries;
    }

    /// Solves a step to `tolerance` [m/s], or leaves `enough` [m/s] where it does not come nearer. `v` holds a guess on entry, contacts the
    /// impulses of before. What is rather taken in two halves (`halves`) is left sooner where it stalls. Contacts open too far to be struck are left out; if some close
    /// all the same, it is solved again with those, from the same guess, until none does.
    pub fn solve(
        &mut self,
        mass: &[Triple],
        free: &[Triple],
        contacts: &mut [Contact],
        v: &mut [Triple],
        (tolerance, enough): (f64, f64),
        halves: bool,
    ) -> Effort {
        contacts.iter_mut().for_each(|contact| contact.leave_out(v, free));
        let mut effort = Effort::default();
        loop {
            let mut survey = Survey::default();
            contacts.iter().for_each(|contact| survey.see(contact));
            let (all, ends) = ((&mut *contacts, &survey), (tolerance, enough));
            effort = effort.then(self.interior.solve(&mut self.matrix, (mass, free), all, v, ends, halves));
            // Of what comes to no solution in a step that is halved, velocities say nothing.
            let mut whole = true;
            for contact in contacts.iter_mut().filter(|contact| contact.left_out && contact.closes(v)) {
                (contact.left_out, whole) = (false, false);
            }
            if whole || halves && !(effort.residual <= enough) {
                return effort;
            }
            v.copy_from_slice(self.interior.guess());
        }
    }
}
