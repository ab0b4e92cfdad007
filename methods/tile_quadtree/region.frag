#version 450 core
// Blended by maximum, so that each texel ends with the bounds of all ground along its ray: what hides
// behind a ridge is in view too, to whoever measures, and a moment later to the viewer.

in vec2 place;
flat in float tile_side;
layout(location = 0) out vec4 bounds;  // -(least column, least row), greatest column, greatest row

void main() {
    // A texel stands for the ground between its neighbours' rays, which near the horizon is far more than a
    // sample; more than a tile would be guesswork. An eighth of a tile is for peaks that rise into view between
    // the vertices that are drawn here.
    vec2 footprint = min(fwidth(place), vec2(tile_side)) + tile_side / 8.0;
    bounds = vec4(footprint - place, place + footprint);
}
