// Draws the ribbons that the compute passes laid.

struct Out {
    @builtin(position) clip: vec4f,
    @location(0) light: vec3f,
    @location(1) share: f32,
}

struct Pixel {
    @location(0) light: vec4f,
    @builtin(sample_mask) samples: u32,
}

@vertex
fn vertex(@location(0) clip: vec4f, @location(1) light: vec3f, @location(2) share: f32) -> Out {
    return Out(clip, light, share);
}

// A hair thinner than a pixel takes some of its four samples, always the same along its way, each hair others: hairs over hairs
// then cover as they should, in whatever order they are drawn, and none breaks into dots.
@fragment
fn fragment(in: Out) -> Pixel {
    let number = floor(in.share * 0.5);
    let share = in.share - 2.0 * number;
    let count = select(u32(4.0 * share + fract(number * 0.6180340)), 4u, share > 0.99);
    let turn = u32(number) & 3u;
    let samples = ((1u << count) - 1u) * 17u;
    return Pixel(vec4f(in.light, 1.0), (samples >> turn) & 15u);
}
