// Lines in space: paths of tips, arrows of wind. As wide on the screen wherever they are, hidden by what is before them.

struct Out {
    @builtin(position) clip: vec4f,
    @location(0) colour: vec4f,
}

@vertex
fn vertex(
    @builtin(vertex_index) corner: u32,
    @location(0) a: vec3f,
    @location(1) width: f32,
    @location(2) b: vec3f,
    @location(3) a_colour: vec4f,
    @location(4) b_colour: vec4f,
) -> Out {
    let at_b = corner >= 2u;
    let p = select(a, b, at_b);
    let eye = toward_eye(p);
    let side = cross(b - a, eye);
    let l = length(side);
    let across = select(g.right.xyz, side / l, l > 1e-6) * 0.5 * width / pixels_per_cm(p);
    let colour = select(a_colour, b_colour, at_b);
    return Out(clip_of(p + select(-across, across, (corner & 1u) == 1u)), colour);
}

@fragment
fn fragment(in: Out) -> @location(0) vec4f {
    return vec4f(in.colour.rgb * in.colour.a, in.colour.a);
}
