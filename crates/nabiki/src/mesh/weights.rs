//! Numbers of the vertices of a mesh, by name: painted weights, and the channels of painted colours.

use glam::Vec3;

use super::Mesh;

/// What the vertices of a mesh have by a name, a number each: a painted weight, the luminance of a colour, or one of its
/// channels.
///
/// They belong to vertices. Where a file has them by corner, a vertex takes those of the first corner that names it.
/// Where vertices at the same place are joined, the first of them keeps its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexWeights {
    /// Name in the file. The channels of a colour follow it with a letter each: `COLOR_0.r`, `COLOR_0.g`, `COLOR_0.b` and,
    /// if there is one, `COLOR_0.a`.
    pub name: String,
    /// One number per vertex. Vertices past the last have 0, because a part of a mesh may lack what another has.
    pub values: Vec<f32>,
}

impl VertexWeights {
    /// That of a vertex.
    pub fn at(&self, vertex: u32) -> f32 {
        self.values.get(vertex as usize).copied().unwrap_or(0.0)
    }

    /// Those of some vertices, which become the first ones in this order.
    pub fn of_vertices(&self, vertices: impl Iterator<Item = u32>) -> Self {
        Self { name: self.name.clone(), values: vertices.map(|v| self.at(v)).collect() }
    }

    /// The mean of the corners of a triangle with these shares, which add up to 1. It lies between the least and the largest
    /// of the three, and is exactly theirs if they are equal.
    pub fn within(&self, triangle: [u32; 3], shares: Vec3) -> f64 {
        let corners = triangle.map(|v| f64::from(self.at(v)));
        let [a, b, c] = corners;
        // From one corner on: shares rarely add up to exactly 1.
        let mean = a + f64::from(shares.y) * (b - a) + f64::from(shares.z) * (c - a);
        let [low, high] = [corners.into_iter().fold(a, f64::min), corners.into_iter().fold(a, f64::max)];
        if mean.is_nan() { mean } else { mean.clamp(low, high) }
    }

    /// The number of the corner with the largest share. Numbers that stand for something, such as that of a part, have no mean.
    pub fn nearest(&self, triangle: [u32; 3], shares: Vec3) -> f64 {
        let corner = if shares.x >= shares.y && shares.x >= shares.z {
            0
        } else if shares.y >= shares.z {
            1
        } else {
            2
        };
        f64::from(self.at(triangle[corner]))
    }
}

/// The letters of a colour's channels.
const CHANNELS: [&str; 4] = ["r", "g", "b", "a"];

impl Mesh {
    /// The weights of a name, which may be that of a channel.
    pub fn weights_named(&self, name: &str) -> Option<&VertexWeights> {
        self.weights.iter().find(|weights| weights.name == name)
    }

    /// The names of all weights, without those of channels.
    pub fn weight_names(&self) -> impl Iterator<Item = &str> {
        self.weights.iter().map(|weights| weights.name.as_str()).filter(|name| !self.is_channel(name))
    }

    fn is_channel(&self, name: &str) -> bool {
        let parts = name.rsplit_once('.');
        parts.is_some_and(|(colour, letter)| CHANNELS.contains(&letter) && self.weights_named(colour).is_some())
    }

    /// Gives the vertices from `first` on these weights. Those before it that have none of this name get 0.
    pub fn add_weights(&mut self, name: &str, first: usize, values: impl Iterator<Item = f32>) {
        let known = self.weights.iter().position(|weights| weights.name == name);
        let at = known.unwrap_or(self.weights.len());
        if known.is_none() {
            self.weights.push(VertexWeights { name: name.to_owned(), values: Vec::new() });
        }
        let all = &mut self.weights[at].values;
        all.resize(first, 0.0);
        all.extend(values);
    }

    /// The same for colours: as their name the luminance, and each channel by its letter. A colour has `channels` numbers, 3 or 4,
    /// one colour after another.
    pub fn add_colours(&mut self, name: &str, first: usize, channels: usize, numbers: &[f32]) {
        let colours = || numbers.chunks_exact(channels);
        self.add_weights(name, first, colours().map(|colour| luminance([colour[0], colour[1], colour[2]])));
        for (channel, letter) in CHANNELS.iter().enumerate().take(channels) {
            self.add_weights(&format!("{name}.{letter}"), first, colours().map(|colour| colour[channel]));
        }
    }
}

/// The luminance of a linear colour (Rec. 709). That of a grey is exactly the grey.
fn luminance(colour: [f32; 3]) -> f32 {
    let [r, g, b] = colour.map(f64::from);
    (r + 0.7152 * (g - r) + 0.0722 * (b - r)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_luminance_of_a_grey_is_the_grey_and_that_of_channels_adds_up_to_white() {
        for i in 0..=255_u8 {
            let grey = f32::from(i) / 255.0;
            assert_eq!(luminance([grey; 3]), grey);
        }
        let of_channels: f32 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(luminance).iter().sum();
        assert!((of_channels - 1.0).abs() < 1e-6, "{of_channels}");
        assert!(luminance([0.9, 1.0, 1.0]) <= 1.0);
    }

    #[test]
    fn a_colour_has_its_luminance_and_its_channels_and_one_name() {
        let mut mesh = Mesh { positions: vec![Vec3::ZERO; 3], ..Mesh::default() };
        mesh.add_weights("part", 0, [3.0, 7.0, 7.0].into_iter());
        // Only the last vertex, as in a second part of the mesh.
        mesh.add_colours("Cd", 2, 4, &[0.25, 0.5, 1.0, 0.75]);
        let at = |name: &str| mesh.weights_named(name).map(|of| [0, 1, 2].map(|v| of.at(v)));
        assert_eq!(at("Cd.g"), Some([0.0, 0.0, 0.5]));
        assert_eq!(at("Cd.a"), Some([0.0, 0.0, 0.75]));
        assert_eq!(at("Cd"), Some([0.0, 0.0, luminance([0.25, 0.5, 1.0])]));
        assert_eq!((at("part"), at("Cd.x")), (Some([3.0, 7.0, 7.0]), None));
        assert_eq!(mesh.weight_names().collect::<Vec<_>>(), ["part", "Cd"]);
        assert_eq!(mesh.weights[0].at(9), 0.0);
    }

    #[test]
    fn a_mean_keeps_within_its_corners_and_numbers_of_parts_are_not_mixed() {
        let of = |values: [f32; 3]| VertexWeights { name: "w".to_owned(), values: values.to_vec() };
        let shares = Vec3::new(0.2, 0.3, 0.5);
        let mean = of([1.0, 0.0, 0.5]).within([0, 1, 2], shares);
        assert!((mean - 0.45).abs() < 1e-6, "{mean}");
        // Shares that add up to more than 1, as rounding may leave them.
        let rough = Vec3::new(0.4, 0.3, 0.3 + f32::EPSILON);
        assert_eq!(of([1.0; 3]).within([0, 1, 2], rough), 1.0);
        assert!(of([1.0, f32::NAN, 1.0]).within([0, 1, 2], Vec3::X).is_nan());
        assert_eq!(of([3.0, 7.0, 9.0]).nearest([0, 1, 2], shares), 9.0);
        assert_eq!(of([3.0, 7.0, 9.0]).nearest([2, 1, 0], Vec3::X), 9.0);
    }
}
