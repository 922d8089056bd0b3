//! Cards: the continuum as finite element programs read it.
//!
//! Numbers of a card are in its own units; plain JSON reads back to the same numbers.

use concio::{InputError, Result};
use serde::{Deserialize, Serialize};

use crate::moduli::{Constants, Couple, Moduli};
use crate::strength::Plane;
use crate::units::Units;

/// Mass of a wall: weight over g on the pitch, mortar without weight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Density {
    /// Per volume [kg/m³].
    pub volume: f64,
    /// Per area of the wall's face [kg/m²].
    pub area: f64,
}

/// How a card is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Everything.
    Json,
    /// `*ELASTIC, TYPE=LAMINA`: Abaqus.
    Lamina,
    /// `*ELASTIC, TYPE=ENGINEERING CONSTANTS`: Abaqus and CalculiX.
    Engineering,
    /// `*SHELL GENERAL SECTION` with A and D apart: Abaqus.
    Shell,
    /// `nDMaterial ElasticOrthotropic`: OpenSees, as Tcl.
    OpenSees,
}

/// A continuum in some units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Card {
    /// Name of the panel.
    pub name: String,
    /// Force and length of all numbers, with the second: `N-mm`.
    pub units: String,
    /// The mass that follows.
    pub unit_of_mass: String,
    /// A, D, F, Cosserat's shear stiffnesses and t. D and F are 0 where a window of the wall was tested.
    pub moduli: Moduli,
    /// Engineering constants; none where stretching and shear are coupled.
    pub constants: Option<Constants>,
    /// Mass.
    pub density: Density,
    /// Whether plate and transverse shear stiffness are known.
    pub out_of_plane: bool,
    /// Strength, if the file has one.
    pub strength: Vec<Plane>,
    /// What the numbers rest on.
    pub assumed: Vec<String>,
}

impl Card {
    /// Of numbers in SI.
    pub fn new(name: &str, units: Units, moduli: &Moduli, density: Density, out_of_plane: bool) -> Card {
        let per = |dimension: [i32; 3]| move |v: f64| units.convert(v, dimension);
        let converted = Moduli {
            membrane: moduli.membrane.map(|row| row.map(per([1, -1, 0]))),
            plate: moduli.plate.map(|row| row.map(per([1, 1, 0]))),
            shear: moduli.shear.map(|row| row.map(per([1, -1, 0]))),
            polar: moduli.polar.map(|row| row.map(per([1, -1, 0]))),
            couple: moduli.couple.map(|c| Couple { c1: per([1, 0, 0])(c.c1), c2: per([1, 0, 0])(c.c2) }),
            thickness: units.convert(moduli.thickness, [0, 1, 0]),
        };
        Card {
            name: name.into(),
            units: units.name(),
            unit_of_mass: units.mass_name(),
            moduli: converted,
            constants: converted.constants(),
            density: Density {
                volume: units.convert(density.volume, [0, -3, 1]),
                area: units.convert(density.area, [0, -2, 1]),
            },
            out_of_plane,
            strength: Vec::new(),
            assumed: Vec::new(),
        }
    }

    /// With planes of strength, in SI.
    pub fn with_strength(mut self, units: Units, planes: &[Plane]) -> Card {
        self.strength = planes.iter().map(|p| Plane { a: p.a, b: units.convert(p.b, [1, -2, 0]) }).collect();
        self
    }

    /// Reads what [`Format::Json`] wrote.
    ///
    /// # Errors
    /// A text that is none.
    pub fn from_json(text: &str) -> Result<Card> {
        Ok(serde_json::from_str(text).map_err(|e| {
            InputError::new(format!("no card: {e}")).allowed("what `concio continuum --card json` wrote")
        })?)
    }

    /// Writes the card.
    ///
    /// # Errors
    /// A bond that leans to one side, or falls apart along an axis, in formats of engineering constants; a window of a wall, of
    /// which D and F are not known, in all but JSON.
    pub fn write(&self, format: Format) -> Result<String> {
        if format != Format::Json && !self.out_of_plane {
            let what = format!(
                "no {} card of an irregular bond: plate and transverse shear stiffness are not known",
                format.name()
            );
            return Err(InputError::new(what).allowed("json, which says what is known").into());
        }
        Ok(match format {
            Format::Json => match serde_json::to_string_pretty(self) {
                Ok(text) => text + "\n",
                Err(e) => return Err(InputError::new(e.to_string()).into()),
            },
            Format::Lamina => self.lamina(self.whole(format)?),
            Format::Engineering => self.engineering(self.whole(format)?),
            Format::OpenSees => self.open_sees(self.whole(format)?),
            Format::Shell => self.shell(),
        })
    }

    fn whole(&self, format: Format) -> Result<&Constants> {
        self.constants.as_ref().ok_or_else(|| {
            let what = format!(
                "no {} card: stretching and shear are coupled, or nothing holds the wall along an axis",
                format.name()
            );
            InputError::new(what).allowed("json, shell").into()
        })
    }

    /// The name as keywords take it.
    fn keyword(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
        let name: String = self.name.chars().map(plain).take(60).collect();
        format!("CONCIO_{name}")
    }

    fn head(&self, mark: &str) -> String {
        let concio = concat!("Concio ", env!("CARGO_PKG_VERSION"));
        let mut text = comment(mark, &format!("{concio}: continuum of a wall, axis 1 along the courses, 2 upwards"));
        text += &comment(mark, &format!("units: {}, mass {}, s", self.units, self.unit_of_mass));
        text += &comment(mark, &format!("thickness: {}", number(self.moduli.thickness)));
        text.extend(self.assumed.iter().map(|what| comment(mark, what)));
        text
    }

    /// What one E, G and t cannot hold.
    fn bending(&self, mark: &str) -> String {
        let Moduli { membrane, plate, thickness, .. } = self.moduli;
        let cubed = thickness * thickness / 12.0;
        let [a, b, c] = [0, 1, 2].map(|i| plate[i][i] / (cubed * membrane[i][i]));
        let what = format!(
            "For the plane of the wall. Bending of such a section is t2/12 of its membrane: D11, D22, D12 of the wall are {a:.3}, {b:.3}, {c:.3} times that; take the shell card for bending"
        );
        comment(mark, &what)
    }

    fn lamina(&self, c: &Constants) -> String {
        let rows = [c.e1, c.e2, c.nu12, c.g12, c.g13, c.g23].map(number).join(", ");
        let (name, density) = (self.keyword(), number(self.density.volume));
        let (head, bending) = (self.head("**"), self.bending("**"));
        format!("{head}{bending}*MATERIAL, NAME={name}\n*ELASTIC, TYPE=LAMINA\n{rows}\n*DENSITY\n{density}\n")
    }

    fn engineering(&self, c: &Constants) -> String {
        let e3 = c.e1.min(c.e2);
        let first = [c.e1, c.e2, e3, c.nu12, 0.0, 0.0, c.g12, c.g13].map(number).join(", ");
        let (name, density, last) = (self.keyword(), number(self.density.volume), number(c.g23));
        let (head, bending) = (self.head("**"), self.bending("**"));
        format!(
            "{head}{bending}** E3 is not known: the lesser of E1 and E2 stands there, nu13 = nu23 = 0.\n\
             ** Plane stress and shells do not use it\n*MATERIAL, NAME={name}\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{first}\n{last}\n*DENSITY\n{density}\n"
        )
    }

    fn open_sees(&self, c: &Constants) -> String {
        let e3 = c.e1.min(c.e2);
        // ν_zx and ν_yz are 0; ν_xy is ν12.
        let numbers =
            [c.e1, c.e2, e3, c.nu12, 0.0, 0.0, c.g12, c.g23, c.g13, self.density.volume].map(number).join(" ");
        let (head, bending) = (self.head("#"), self.bending("#"));
        format!(
            "{head}{bending}# E3 is not known: the lesser of E1 and E2 stands there; wrap it as PlaneStress. Set concioTag before\n\
             if {{![info exists concioTag]}} {{ set concioTag 1 }}\n\
             nDMaterial ElasticOrthotropic $concioTag {numbers}\n"
        )
    }

    fn shell(&self) -> String {
        let m = &self.moduli;
        let of = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => m.membrane[i][j],
            (false, false) => m.plate[i - 3][j - 3],
            _ => 0.0,
        };
        let half: Vec<String> =
            (0..6).flat_map(|j| (0..=j).map(move |i| (i, j))).map(|(i, j)| number(of(i, j))).collect();
        let rows = half.chunks(8).map(|row| row.join(", ")).collect::<Vec<_>>().join(",\n");
        let shear = [m.shear[0][0], m.shear[1][1], m.shear[0][1]].map(number).join(", ");
        let (name, density, head) = (self.keyword(), number(self.density.area), self.head("**"));
        format!(
            "{head}** DENSITY is mass per area. Membrane rows A, bending rows D, twist as 2 chi12\n\
             *SHELL GENERAL SECTION, ELSET={name}, DENSITY={density}\n{rows}\n*TRANSVERSE SHEAR\n{shear}\n"
        )
    }
}

impl Format {
    /// As it is typed.
    pub fn name(self) -> &'static str {
        match self {
            Format::Json => "json",
            Format::Lamina => "lamina",
            Format::Engineering => "engineering",
            Format::Shell => "shell",
            Format::OpenSees => "opensees",
        }
    }
}

/// Ten digits: keyword readers have fields of 20 characters.
fn number(value: f64) -> String {
    if value == 0.0 { "0.".into() } else { format!("{value:.9E}") }
}

/// Widest line of a comment: keyword readers take 256 characters.
const WIDEST: usize = 100;

/// A text as lines of comment.
fn comment(mark: &str, text: &str) -> String {
    let (mut lines, mut width) = (String::from(mark), mark.len());
    for word in text.split_whitespace() {
        let letters = word.chars().count();
        if width + 1 + letters > WIDEST && width > mark.len() {
            lines += "\n";
            lines += mark;
            width = mark.len();
        }
        lines += " ";
        lines += word;
        width += 1 + letters;
    }
    lines + "\n"
}
