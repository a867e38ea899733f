//! The text beside the texture: what is in it, and how an engine plays it.

use glam::Vec3;

use super::layout::Layout;

/// The numbers of a texture.
pub(super) struct Numbers<'a> {
    /// The name of the texture's file.
    pub name: &'a str,
    pub layout: &'a Layout,
    pub strands: usize,
    pub ribbons: bool,
    pub frame_rate: f64,
    pub first_frame: i32,
    /// The box around the hair in all frames (m).
    pub bounds: [Vec3; 2],
}

pub(super) fn text(numbers: &Numbers<'_>) -> String {
    let &Numbers { name, layout, strands, frame_rate, first_frame, bounds: [low, high], .. } = numbers;
    let Layout { vertices, frames, width, rows, .. } = *layout;
    let (height, step) = (layout.height(), layout.v_of_a_frame());
    let drawn = if numbers.ribbons { "ribbons, two vertices at each point" } else { "lines, one vertex at each point" };
    format!(
        "\
Hair that moves by a vertex-animation texture, written by Nabiki
================================================================

    {name}        the texture: where every vertex is in every frame
    {name}.glb    the mesh, in its first frame: {drawn}
    {name}.txt    this page


The numbers
-----------

    width, height            {width} x {height} texels
    frames                   {frames}
    frames per second        {frame_rate}
    length                   {length} s
    vertices                 {vertices}, of {strands} strands
    rows of a frame          {rows}
    v from frame to frame    {step}
    box of all frames        from {low} to {high} (m)
    first frame              number {first_frame} of the shot


The texture
-----------

OpenEXR, four channels of 32-bit floats, ZIP compression, which loses nothing.

    R, G, B   the position of the vertex: metres, y up, in the world. It includes the motion of the head.
    A         how far along its strand the vertex is: 0 at the root, 1 at the tip. It is not transparency.

Vertex number i of the mesh is in column i mod {width}, and in frame n in row {rows} n + floor(i / {width}), counted from the
top. Unused texels are 0. TEXCOORD_1 of the mesh is the centre of the vertex's texel in the first frame; v runs from the
top, as glTF has it. Add {step} to v for each later frame.

NORMAL is that of the first frame.


Import
------

The texture: no filter (nearest), no mipmaps, clamped, linear data (no sRGB), 32 bits a channel, not resized. Alpha is
data, too: nothing is multiplied by it.
The mesh: the second texture coordinates need 32 bits. Set its bounds to the box above, or the hair vanishes when its first
frame is out of view.

    Unreal     Compression HDR F32 and filter Nearest; in the mesh's build settings, full precision UVs. Unreal takes glTF's
               (x, y, z) m to (x, z, y) * 100 cm; do the same with the texel. World Position Offset is the result minus the
               absolute world position.
    Unity      Format RGBA Float, sRGB off. glTFast negates x and turns v around: negate the texel's x, and subtract the step
               of v instead of adding it.
    Godot      Compression off (lossless).
    Blender    Colour space Non-Color. It turns v around: subtract the step. Its z is glTF's y, and its y glTF's -z. It
               drops the texture coordinates of lines.
    three.js   EXRLoader turns the picture around, but nothing turns v: sample at 1 - v.


A vertex shader, GLSL
---------------------

    uniform sampler2D positions;
    uniform mat4 view_projection;
    uniform float seconds;
    in vec2 texel;                            // TEXCOORD_1
    void main() {{
        float frame = clamp(seconds * {frame_rate:?}, 0.0, {last:?}), n = floor(frame);
        vec3 a = textureLod(positions, texel + vec2(0.0, n * {step:?}), 0.0).xyz;
        vec3 b = textureLod(positions, texel + vec2(0.0, min(n + 1.0, {last:?}) * {step:?}), 0.0).xyz;
        gl_Position = view_projection * vec4(mix(a, b, frame - n), 1.0);
    }}

HLSL: positions.SampleLevel(nearest, uv, 0) for textureLod, lerp for mix, float2 to float4 for vec2 to vec4.
",
        length = (frames - 1) as f64 / frame_rate,
        last = (frames - 1) as f64,
    )
}
