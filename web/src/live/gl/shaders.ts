// SPDX-License-Identifier: Apache-2.0
// The shaders of live pictures. They apply doc/ray.md ("Geometry", "Bilinear", "Lens weights", "Feather") to elements.

export const IMAGES_PER_DRAW = 64;
export const VECTORS_PER_IMAGE = 6; // in the block Images
export const NODES_PER_ROW = 1024; // width of the texture of weights

export const TRIANGLE = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}`;

// Adds the rays of some LF images to the sums of elements: R, G, B times weight, and weight.
export const COLLECT = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
precision highp usampler2DArray;

uniform sampler2D earlier;        // sums of the draws before this one
uniform usampler2DArray pixels;   // R, G, B in linear light, and 1, or 0 if the pixel is masked
uniform usampler2D nodes;         // weights in 1/256
uniform ivec2 plate;              // columns and rows of elements
uniform ivec2 grid;               // columns and rows of nodes
uniform int count;                // LF images of this draw
uniform vec3 front;
uniform int blades;               // 0: round
uniform float rotation;
uniform vec2 squeeze;             // of the opening's width and height, by an anamorphic lens
uniform vec2 arc;                 // radius of the arcs of the blades, and their centres; (0, 0): straight
uniform bool hasFeather;
uniform float rim;                // relative tolerance of the opening
layout(std140) uniform Images {
  // For each LF image: three rows of RayForms.pixel, with width, height, and the width of the border in which blocks
  // may be feathered; forward, with the layer; lensRight, with shift_x + 8 shift_y + 64 samples; lensUp, with the index
  // of the first node.
  vec4 images[${IMAGES_PER_DRAW * VECTORS_PER_IMAGE}];
};
out vec4 sum;

const int kBlock = 8;
const float kPi = 3.14159265358979;

vec4 part(int image, int i) { return images[image * ${VECTORS_PER_IMAGE} + i]; }

// The opening has the radius 1. A polygon has a corner straight up at rotation 0, and turns from right towards up.
bool passes(vec2 onLens) {
  vec2 at = onLens / squeeze;
  if (blades == 0) return dot(at, at) <= 1.0 + 2.0 * rim;
  float between = 2.0 * kPi / float(blades);
  float angle = atan(at.y, at.x) - 0.5 * kPi - rotation - 0.5 * between;
  float fromEdge = angle - between * round(angle / between);
  if (arc.x > 0.0) return length(length(at) * vec2(cos(fromEdge), sin(fromEdge)) - vec2(arc.y, 0.0)) <= arc.x + rim;
  return length(at) * cos(fromEdge) <= cos(0.5 * between) * (1.0 + rim);
}

// Finds where the LF image recorded the ray of a position on the plate. Returns false if there is no such ray.
bool recordedAt(int image, vec2 position, out vec2 at) {
  vec3 e = vec3(position - 0.5 * vec2(plate), 1.0);
  float forward = dot(part(image, 3).xyz, e);
  vec3 p = vec3(dot(part(image, 0).xyz, e), dot(part(image, 1).xyz, e), dot(part(image, 2).xyz, e));
  if (forward < 0.0) p = -p;
  at = p.xy / p.z;
  return dot(front, e) > 0.0 && forward != 0.0 && p.z > 0.0;
}

vec2 onLens(int image, vec2 position) {
  vec3 e = vec3(position - 0.5 * vec2(plate), 1.0);
  return vec2(dot(part(image, 4).xyz, e), dot(part(image, 5).xyz, e)) / dot(part(image, 3).xyz, e);
}

// Interpolates between four pixels. Returns false unless all of them exist.
bool interpolated(int image, vec2 at, out vec3 value) {
  vec2 size = vec2(part(image, 0).w, part(image, 1).w);
  vec2 corner = at - 0.5;
  if (any(lessThan(corner, vec2(0.0))) || any(greaterThanEqual(corner, size - 1.0))) return false;
  // The position is rounded to 1/256 px before the four pixels are chosen, as by the server.
  ivec2 place = ivec2(floor(corner * 256.0 + 0.5));
  ivec2 upperLeft = min(place >> 8, ivec2(size) - 2);
  vec2 share = vec2(place - 256 * upperLeft) / 256.0;
  ivec3 first = ivec3(upperLeft, int(part(image, 3).w));
  uvec4 a = texelFetch(pixels, first, 0);
  uvec4 b = texelFetch(pixels, first + ivec3(1, 0, 0), 0);
  uvec4 c = texelFetch(pixels, first + ivec3(0, 1, 0), 0);
  uvec4 d = texelFetch(pixels, first + ivec3(1, 1, 0), 0);
  value = mix(mix(vec3(a.rgb), vec3(b.rgb), share.x), mix(vec3(c.rgb), vec3(d.rgb), share.x), share.y);
  return (a.a & b.a & c.a & d.a) != 0u;
}

uint node(int index) { return texelFetch(nodes, ivec2(index % ${NODES_PER_ROW}, index / ${NODES_PER_ROW}), 0).r; }

// Returns the first element after the block of an element.
ivec2 blockEnd(int shifts, ivec2 element) {
  ivec2 shift = ivec2(shifts & 7, (shifts >> 3) & 7);
  return ((element + shift) / kBlock + 1) * kBlock - shift;
}

uint weightOf(int image, ivec2 end) {
  int begin = int(part(image, 5).w);
  ivec2 middle = clamp(end - kBlock / 2, ivec2(0), plate - 1);
  ivec2 place = 256 * middle * (grid - 1) / plate;
  ivec2 at = place >> 8;
  uvec2 share = uvec2(place & 255);
  int right = grid.x > 1 ? 1 : 0;
  int below = grid.y > 1 ? grid.x : 0;
  int upper = begin + at.y * grid.x + at.x;
  uint above = node(upper) * (256u - share.x) + node(upper + right) * share.x;
  uint under = node(upper + below) * (256u - share.x) + node(upper + below + right) * share.x;
  return (above * (256u - share.y) + under * share.y + 8388608u) >> 24;
}

float smoothShare(float t) {
  t = clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// Returns the feather at a corner of a block, in 1/256.
uint featherAt(int image, ivec2 corner) {
  vec2 at;
  if (!recordedAt(image, vec2(corner), at)) return 0u;
  vec2 size = vec2(part(image, 0).w, part(image, 1).w);
  vec2 inside = min(at - 0.5, size - 0.5 - at) / (min(size.x, size.y) / 32.0);
  return uint(256.0 * smoothShare(inside.x) * smoothShare(inside.y) + 0.5);
}

uint feathered(int image, uint weight, ivec2 element, ivec2 end) {
  ivec2 begin = end - kBlock;
  uvec2 to = uvec2(2 * (element - begin) + 1);
  uvec2 from = uint(2 * kBlock) - to;
  uint upper = featherAt(image, begin) * from.x + featherAt(image, ivec2(end.x, begin.y)) * to.x;
  uint lower = featherAt(image, ivec2(begin.x, end.y)) * from.x + featherAt(image, end) * to.x;
  uint feather = upper * from.y + lower * to.y;
  return max(min(weight, 1u), (weight * feather + 32768u) >> 16);
}

void main() {
  ivec2 element = ivec2(gl_FragCoord.xy);
  sum = texelFetch(earlier, element, 0);
  for (int image = 0; image < count; ++image) {
    int shifts = int(part(image, 4).w);
    ivec2 end = blockEnd(shifts, element);
    uint weight = weightOf(image, end);
    if (weight == 0u) continue;
    int samples = shifts >> 6;
    vec3 value = vec3(0.0);
    float rays = 0.0;
    vec2 last = vec2(0.0);
    for (int i = 0; i < samples * samples; ++i) {
      vec2 position = vec2(element) + (vec2(i % samples, i / samples) + 0.5) / float(samples);
      vec2 at;
      vec3 ray;
      if (!recordedAt(image, position, at) || !passes(onLens(image, position)) || !interpolated(image, at, ray))
        continue;
      value += ray;
      rays += 1.0;
      last = at;
    }
    if (rays == 0.0) continue;
    vec2 inside = min(last, vec2(part(image, 0).w, part(image, 1).w) - last);
    if (hasFeather && min(inside.x, inside.y) < part(image, 2).w) weight = feathered(image, weight, element, end);
    sum += vec4(value / rays, 1.0) * float(weight);
  }
}`;

// Divides sums by weights, and packs two elements into one: R, G, B and the sum of the weights as half floats. Elements
// are counted row by row, so that the rows of the result need not be those of the plate.
export const DEVELOP = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D sums;
uniform ivec2 plate;
uniform mat3 colours;
uniform float pedestal;
out uvec4 packed;

uvec2 developed(int index) {
  if (index >= plate.x * plate.y) return uvec2(0u);
  vec4 sum = texelFetch(sums, ivec2(index % plate.x, index / plate.x), 0);
  vec3 light = sum.a > 0.0 ? colours * (sum.rgb / sum.a - pedestal) : vec3(0.0);
  return uvec2(packHalf2x16(light.rg), packHalf2x16(vec2(light.b, min(sum.a, 65504.0))));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int first = 2 * (at.y * plate.x + at.x);
  packed = uvec4(developed(first), developed(first + 1));
}`;
