// Draws triangles whose corners are lit.

struct Out {
    @builtin(position) clip: vec4f,
    @location(0) light: vec3f,
}

@vertex
fn vertex(@location(0) place: vec3f, @location(1) light: vec3f) -> Out {
    return Out(clip_of(place), light);
}

@fragment
fn fragment(in: Out) -> @location(0) vec4f {
    return vec4f(in.light, 1.0);
}
