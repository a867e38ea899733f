//! The tools of the view: the hand that pulls, the brush that paints regions, the comb that makes aims.

/// What the left button does on hair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Pulls a lock: the wind follows.
    #[default]
    Pull,
    /// Paints how much hair belongs to a region.
    Paint,
    /// Combs hair in a frame: an aim leads it there.
    Comb,
}

/// What a stroke of the brush does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// Adds hair to the region.
    #[default]
    Add,
    /// Takes it out.
    Erase,
    /// Evens the weights out.
    Smooth,
    /// Adds what a line is drawn around.
    Lasso,
}

impl Stroke {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Add, "Add"), (Self::Erase, "Erase"), (Self::Smooth, "Smooth"), (Self::Lasso, "Lasso")];
}

/// The smallest and the largest brush (points).
pub const RADII: std::ops::RangeInclusive<f32> = 4.0..=250.0;

/// The tool at hand, and how it is set.
#[derive(Clone, Debug, PartialEq)]
pub struct Tools {
    /// The tool.
    pub tool: Tool,
    /// Radius of brush and comb (points).
    pub radius: f32,
    /// How much of its weight a stroke of the brush gives, 0..1.
    pub strength: f32,
    /// What a stroke does.
    pub stroke: Stroke,
    /// Whether it does the same on the other side of the head.
    pub mirror: bool,
    /// The region that is painted; without one, a stroke begins a new one.
    pub region: Option<usize>,
}

impl Default for Tools {
    fn default() -> Self {
        Self { tool: Tool::Pull, radius: 40.0, strength: 1.0, stroke: Stroke::Add, mirror: false, region: None }
    }
}

impl Tools {
    /// The tool, or the hand if it is at hand already.
    pub fn toggle(&mut self, tool: Tool) {
        self.tool = if self.tool == tool { Tool::Pull } else { tool };
    }

    /// A larger or smaller brush.
    pub fn resize(&mut self, larger: bool) {
        let radius = self.radius * if larger { 1.25 } else { 0.8 };
        self.radius = radius.clamp(*RADII.start(), *RADII.end());
    }
}
