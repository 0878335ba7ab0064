//! What decides a fragment's answer, and which fragments the network is spared.

use serde::{Deserialize, Serialize};

/// Which fragments a network is run for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Skip {
    /// All; what is known exactly then replaces its answers.
    None,
    /// Those whose answer is used: the same transmittances to the bit.
    #[default]
    Exact,
    /// Those that can be seen: no channel of the image changes by more than half a display step, 1/512; see
    /// [`visible`](crate::features::visible).
    Visible,
}

impl Skip {
    /// What it switches on.
    pub fn switches(self) -> Switches {
        match self {
            Self::None => Switches::default(),
            Self::Exact => Switches {
                ends: true,
                short: true,
                ..Switches::default()
            },
            Self::Visible => Switches {
                ends: true,
                short: true,
                faint: true,
                hidden: true,
            },
        }
    }
}

/// Which fragments the network is spared. Those that are known stay known: a switch that is off only runs the network
/// for them too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Switches {
    /// Nearest, farthest, and those with nothing else in their pixel.
    pub ends: bool,
    /// Pixels of three and four in closed form.
    pub short: bool,
    /// Pixels that absorb next to nothing; see [`visible`](crate::features::visible).
    pub faint: bool,
    /// What lies behind so much that it is not seen; see [`visible`](crate::features::visible).
    pub hidden: bool,
}

/// What decides a fragment's answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u8)]
pub enum Class {
    /// Nearest of its pixel: T = 1.
    Nearest,
    /// The others absorb nothing: T = 1.
    Alone,
    /// Farthest of its pixel: T = e^−b_0'.
    Farthest,
    /// One of three: closed form.
    Three,
    /// One of four: closed form.
    Four,
    /// Known without the network, which rule said so not being told apart.
    Known,
    /// Of a faint pixel: e^(−b_0'/2).
    Faint,
    /// Hidden: e^−b_0'.
    Hidden,
    /// The network.
    Network,
}

impl Class {
    /// Every class.
    pub const ALL: [Self; 9] = [
        Self::Nearest,
        Self::Alone,
        Self::Farthest,
        Self::Three,
        Self::Four,
        Self::Known,
        Self::Faint,
        Self::Hidden,
        Self::Network,
    ];

    /// Its name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Alone => "alone",
            Self::Farthest => "farthest",
            Self::Three => "three",
            Self::Four => "four",
            Self::Known => "known",
            Self::Faint => "faint",
            Self::Hidden => "hidden",
            Self::Network => "network",
        }
    }
}

/// What pass 2 did, and how long it took.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Fragments of every class, in the order of [`Class::ALL`].
    pub classes: [u64; Class::ALL.len()],
    /// Rows that the network was run for.
    pub rows: u64,
    /// Time of pass 1 \[s\].
    pub seconds_pass_1: f64,
    /// Time of pass 2 \[s\].
    pub seconds_pass_2: f64,
}

impl Tally {
    /// Fragments of a class.
    pub fn of(&self, class: Class) -> u64 {
        self.classes[class as usize]
    }

    /// All fragments.
    pub fn fragments(&self) -> u64 {
        self.classes.iter().sum()
    }

    /// Adds what was done elsewhere.
    pub fn add(&mut self, other: &Self) {
        self.classes.iter_mut().zip(other.classes).for_each(|(a, b)| *a += b);
        self.rows += other.rows;
        self.seconds_pass_1 += other.seconds_pass_1;
        self.seconds_pass_2 += other.seconds_pass_2;
    }
}
