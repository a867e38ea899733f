//! Small FBX files as text of version 7.4.

use glam::{DAffine3, DVec3};

/// Ticks of FBX in a second.
pub const SECOND: f64 = 46_186_158_000.0;

/// A vertex, and how a blend shape moves it.
pub type Moved = (usize, [f64; 3]);

/// A file that is being written.
pub struct Text {
    settings: String,
    objects: String,
    connections: String,
}

fn array(name: &str, values: impl IntoIterator<Item = f64>) -> String {
    let values: Vec<String> = values.into_iter().map(|value| value.to_string()).collect();
    format!("{name}: *{} {{ a: {} }}\n", values.len(), values.join(","))
}

fn matrix(name: &str, m: &DAffine3) -> String {
    array(name, glam::DMat4::from(*m).to_cols_array())
}

impl Text {
    /// A file in centimetres whose axes are numbered from 0: right, up and front, with their signs.
    pub fn new(axes: [(usize, i32); 3], unit: f64) -> Self {
        let row = |(name, (axis, sign)): (&str, (usize, i32))| {
            format!(
                "P: \"{name}\", \"int\", \"Integer\", \"\",{axis}\nP: \"{name}Sign\", \"int\", \"Integer\", \"\",{sign}\n"
            )
        };
        let mut settings: String = ["CoordAxis", "UpAxis", "FrontAxis"].into_iter().zip(axes).map(row).collect();
        settings += &format!("P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{unit}\n");
        settings += "P: \"TimeMode\", \"enum\", \"\", \"\",6\n";
        Self { settings, objects: String::new(), connections: String::new() }
    }

    /// In centimetres, with y up.
    pub fn plain() -> Self {
        Self::new([(0, 1), (1, 1), (2, 1)], 1.0)
    }

    pub fn bytes(&self) -> Vec<u8> {
        let Self { settings, objects, connections } = self;
        format!(
            "; FBX 7.4.0 project file\nFBXHeaderExtension: {{\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}}\n\
             GlobalSettings: {{\nVersion: 1000\nProperties70: {{\n{settings}}}\n}}\nObjects: {{\n{objects}}}\n\
             Connections: {{\n{connections}}}\n"
        )
        .into_bytes()
    }

    pub fn object(&mut self, kind: &str, number: u32, name: &str, class: &str, inside: &str) -> &mut Self {
        self.objects += &format!("{kind}: {number}, \"{name}\", \"{class}\" {{\n{inside}}}\n");
        self
    }

    /// Puts one object below another, 0 for the scene.
    pub fn below(&mut self, child: u32, parent: u32) -> &mut Self {
        self.connections += &format!("C: \"OO\",{child},{parent}\n");
        self
    }

    /// Lets an object drive a property.
    pub fn drives(&mut self, driver: u32, driven: u32, property: &str) -> &mut Self {
        self.connections += &format!("C: \"OP\",{driver},{driven}, \"{property}\"\n");
        self
    }

    /// A node below another. Properties are rows such as `("Lcl Translation", "1,2,3")`.
    pub fn node(
        &mut self,
        number: u32,
        name: &str,
        class: &str,
        parent: u32,
        properties: &[(&str, &str)],
    ) -> &mut Self {
        let rows: String =
            properties.iter().map(|(key, v)| format!("P: \"{key}\", \"{key}\", \"\", \"A\",{v}\n")).collect();
        let inside = format!("Version: 232\nProperties70: {{\n{rows}}}\n");
        self.object("Model", number, &format!("Model::{name}"), class, &inside).below(number, parent)
    }

    /// A mesh of polygons at a node.
    pub fn mesh(&mut self, number: u32, node: u32, vertices: &[[f64; 3]], polygons: &[&[usize]]) -> &mut Self {
        self.mesh_with(number, node, vertices, polygons, "")
    }

    /// The same, with further layers.
    pub fn mesh_with(
        &mut self,
        number: u32,
        node: u32,
        vertices: &[[f64; 3]],
        polygons: &[&[usize]],
        layers: &str,
    ) -> &mut Self {
        let ends = |polygon: &&[usize]| {
            let last = polygon.len() - 1;
            polygon
                .iter()
                .enumerate()
                .map(|(i, &v)| if i == last { -(v as f64) - 1.0 } else { v as f64 })
                .collect::<Vec<_>>()
        };
        let inside = array("Vertices", vertices.iter().flatten().copied())
            + &array("PolygonVertexIndex", polygons.iter().flat_map(ends))
            + layers;
        self.object("Geometry", number, "Geometry::", "Mesh", &inside).below(number, node)
    }

    /// A layer of colours for the corners of a mesh.
    pub fn colours(name: &str, colours: &[[f64; 4]]) -> String {
        format!(
            "LayerElementColor: 0 {{\nVersion: 101\nName: \"{name}\"\nMappingInformationType: \"ByPolygonVertex\"\n\
             ReferenceInformationType: \"Direct\"\n{}}}\nLayer: 0 {{\nVersion: 100\nLayerElement: {{\n\
             Type: \"LayerElementColor\"\nTypedIndex: 0\n}}\n}}\n",
            array("Colors", colours.iter().flatten().copied())
        )
    }

    /// A skin of a mesh.
    pub fn skin(&mut self, number: u32, mesh: u32, kind: &str) -> &mut Self {
        let inside = format!("Version: 101\nSkinningType: \"{kind}\"\n");
        self.object("Deformer", number, "Deformer::", "Skin", &inside).below(number, mesh)
    }

    /// The vertices and weights of a joint, which was at `joint_bound` when a mesh at the origin was bound to it. Joint 0 is missing.
    pub fn cluster(
        &mut self,
        number: u32,
        skin: u32,
        joint: u32,
        weights: &[(usize, f64)],
        joint_bound: DVec3,
    ) -> &mut Self {
        let bound = DAffine3::from_translation(joint_bound);
        let inside = String::from("Version: 100\n")
            + &array("Indexes", weights.iter().map(|&(v, _)| v as f64))
            + &array("Weights", weights.iter().map(|&(_, weight)| weight))
            + &matrix("Transform", &bound.inverse())
            + &matrix("TransformLink", &bound);
        self.object("Deformer", number, "SubDeformer::", "Cluster", &inside).below(number, skin);
        if joint != 0 {
            self.below(joint, number);
        }
        self
    }

    /// A blend shape of a mesh with one channel at `percent`: the weights (per cent) at which it reaches each of its shapes, which
    /// move vertices. It has this number, its channel the next, and its shapes those after that.
    pub fn shapes(&mut self, number: u32, mesh: u32, percent: f64, shapes: &[(f64, &[Moved])]) -> &mut Self {
        self.object("Deformer", number, "Deformer::", "BlendShape", "Version: 100\n").below(number, mesh);
        let inside = format!("Version: 100\nDeformPercent: {percent}\n")
            + &array("FullWeights", shapes.iter().map(|&(full, _)| full));
        self.object("Deformer", number + 1, "SubDeformer::smile", "BlendShapeChannel", &inside)
            .below(number + 1, number);
        for (n, (_, moved)) in (number + 2..).zip(shapes) {
            let inside = String::from("Version: 100\n")
                + &array("Indexes", moved.iter().map(|&(v, _)| v as f64))
                + &array("Vertices", moved.iter().flat_map(|(_, by)| *by));
            self.object("Geometry", n, "Geometry::smile", "Shape", &inside).below(n, number + 1);
        }
        self
    }

    /// An animation; its layer has the next number. `last`: its time span (s).
    pub fn stack(&mut self, number: u32, name: &str, span: Option<[f64; 2]>) -> &mut Self {
        let row =
            |(key, time): (&str, f64)| format!("P: \"{key}\", \"KTime\", \"Time\", \"\",{}\n", (time * SECOND).round());
        let rows: String =
            span.into_iter().flat_map(|s| ["LocalStart", "LocalStop"].into_iter().zip(s)).map(row).collect();
        self.object(
            "AnimationStack",
            number,
            &format!("AnimStack::{name}"),
            "",
            &format!("Properties70: {{\n{rows}}}\n"),
        );
        self.object("AnimationLayer", number + 1, "AnimLayer::base", "", "").below(number + 1, number)
    }

    /// Moves a property of an object by straight lines between keys (s): parts such as `d|X` of `Lcl Translation`, or
    /// `d|DeformPercent`. Its curves have the numbers after this.
    pub fn curves(
        &mut self,
        number: u32,
        layer: u32,
        (object, property): (u32, &str),
        parts: &[(&str, &[(f64, f64)])],
    ) -> &mut Self {
        let first =
            |(part, keys): &(&str, &[(f64, f64)])| format!("P: \"{part}\", \"Number\", \"\", \"A\",{}\n", keys[0].1);
        let rows: String = parts.iter().map(first).collect();
        self.object("AnimationCurveNode", number, "AnimCurveNode::", "", &format!("Properties70: {{\n{rows}}}\n"));
        self.below(number, layer).drives(number, object, property);
        for (n, (part, keys)) in (number + 1..).zip(parts) {
            let inside = String::from("Default: 0\nKeyVer: 4008\n")
                + &array("KeyTime", keys.iter().map(|&(time, _)| (time * SECOND).round()))
                + &array("KeyValueFloat", keys.iter().map(|&(_, value)| value))
                + "KeyAttrFlags: *1 { a: 4 }\nKeyAttrDataFloat: *4 { a: 0,0,0,0 }\n"
                + &array("KeyAttrRefCount", [keys.len() as f64]);
            self.object("AnimationCurve", n, "AnimCurve::", "", &inside).drives(n, number, part);
        }
        self
    }
}
