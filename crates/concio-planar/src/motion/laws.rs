//! Laws of joints: those that are alike are kept once.

use super::Link;
use crate::joint::{Law, Part};

/// Laws among which one that is alike is looked for: a wall of bricks has a few, one of stones none that are alike.
const KNOWN: usize = 64;

/// The law of every joint. Walls have thousands of joints, all of them asked twice in each step, and few laws, which stay at hand.
#[derive(Debug, Clone)]
pub(super) struct Laws {
    all: Vec<Law>,
    /// Their parts, of those that are bonded: what is held, what has cracked, what stays.
    parts: Vec<Option<Box<[Law; 3]>>>,
    /// Where each joint's is among them.
    which: Vec<u32>,
    /// That of bodies that come together.
    other: Law,
}

impl Laws {
    pub fn new(links: &[Link], other: Law) -> Self {
        let (mut all, mut which) = (Vec::new(), Vec::with_capacity(links.len()));
        for Link { law, .. } in links {
            let known = all.len().saturating_sub(KNOWN);
            let at = all[known..].iter().position(|known| known == law).map_or(all.len(), |at| known + at);
            if at == all.len() {
                all.push(*law);
            }
            which.push(at as u32);
        }
        let parts = [Part::Held, Part::Dry, Part::Stays];
        let of_bonded = |law: &Law| law.bond.map(|_| Box::new(parts.map(|part| law.part(part))));
        Laws { parts: all.iter().map(of_bonded).collect(), all, which, other }
    }

    /// That of a joint, or of bodies without.
    #[inline(always)]
    pub fn of(&self, link: Option<usize>) -> &Law {
        link.map_or(&self.other, |link| &self.all[self.which[link] as usize])
    }

    /// That of a part of a joint, or of bodies without.
    #[inline(always)]
    pub fn part(&self, link: Option<usize>, part: Part) -> &Law {
        let bonded = || self.parts[self.which[link?] as usize].as_deref();
        match (part, bonded()) {
            (Part::Held, Some([held, ..])) => held,
            (Part::Dry, Some([_, dry, _])) => dry,
            (Part::Stays, Some([.., stays])) => stays,
            _ => self.of(link),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Friction;

    /// Joints have the laws that they were given, and those that are alike one.
    #[test]
    fn joints_have_their_laws() {
        let law = |k: usize| Law::dry(Some(Friction::coulomb(0.1 + 0.001 * (k % 100) as f64)));
        for distinct in [3, 1000] {
            let links: Vec<Link> = (0..1000).map(|k| Link::closed(None, k, law(k % distinct))).collect();
            let laws = Laws::new(&links, law(7));
            assert!((0..1000).all(|k| *laws.of(Some(k)) == links[k].law));
            assert_eq!(*laws.of(None), law(7));
            assert_eq!(laws.all.len(), if distinct == 3 { 3 } else { 1000 });
        }
    }
}
