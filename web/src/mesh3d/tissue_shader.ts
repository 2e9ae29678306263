// tissue_shader.ts — how tissue takes light, in GLSL: what makes it moist flesh and not plastic.
//
//   colour    mottled in three sizes by noise of the rest position, so it sticks to the tissue when that is pressed
//   relief    the same noise's exact gradient, carried onto the screen by its derivatives; fades where it is finer than pixels
//   scatter   light wraps around the edge of a shadow, red farthest: light that went in comes out beside
//   film      a thin moist coat: soft boxes of light, mirrored by the share that a surface of water reflects, broken by relief
//   shade     share of the sky at rest, hollows as they are now, and what instruments take of it
//
// FINE is not defined where drawing is slow: then one light, its highlight and the shade are left. Lengths are in units of the body.
export const VERTEX = /* glsl */ `
#include <clipping_planes_pars_vertex>
attribute vec3 rest;
attribute float sky;
attribute float hollow;
attribute float value;
attribute float raw;
attribute vec3 tint;
attribute float mottle;
varying vec3 vNormal;
varying vec3 vPlace;
varying vec3 vWorld;
varying vec3 vRest;
varying vec3 vShade;
varying float vValue;
varying vec3 vTint;
varying float vMottle;
uniform float perSize;
void main() {
  vec3 objectNormal = normal;
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  vPlace = mvPosition.xyz;
  vWorld = position;
  vNormal = normalMatrix * objectNormal;
  vRest = rest * perSize;
  vShade = vec3(sky, hollow, raw);
  vValue = value;
  vTint = tint;
  vMottle = mottle;
  gl_Position = projectionMatrix * mvPosition;
  #include <clipping_planes_vertex>
}
`;

/** Value noise with its gradient, after no table: the hash is of integers, the same on every card. */
const NOISE = /* glsl */ `
float hashAt(ivec3 cell) {
  uvec3 q = uvec3(cell) * uvec3(1597334673u, 3812015801u, 2798796415u);
  uint n = q.x ^ q.y ^ q.z;
  n = (n ^ (n >> 15u)) * 2246822519u;
  n = (n ^ (n >> 13u)) * 3266489917u;
  return float((n ^ (n >> 16u)) >> 8u) / 16777215.0;
}
// Turned, so that no face of a box lies along the lattice.
const mat3 TURN = mat3(0.00, 0.80, 0.60, -0.80, 0.36, -0.48, -0.60, -0.48, 0.64);
// xyz: gradient, w: value in 0 .. 1
vec4 latticeNoise(vec3 x) {
  ivec3 i = ivec3(floor(x));
  vec3 f = fract(x);
  vec3 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  vec3 du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
  float a = hashAt(i), b = hashAt(i + ivec3(1, 0, 0)), c = hashAt(i + ivec3(0, 1, 0)), d = hashAt(i + ivec3(1, 1, 0));
  float e = hashAt(i + ivec3(0, 0, 1)), g = hashAt(i + ivec3(1, 0, 1)), h = hashAt(i + ivec3(0, 1, 1));
  float k = hashAt(i + ivec3(1, 1, 1));
  float k1 = b - a, k2 = c - a, k3 = e - a;
  float k4 = a - b - c + d, k5 = a - c - e + h, k6 = a - b - e + g, k7 = -a + b + c - d + e - g - h + k;
  float value = a + k1 * u.x + k2 * u.y + k3 * u.z + k4 * u.x * u.y + k5 * u.y * u.z + k6 * u.z * u.x + k7 * u.x * u.y * u.z;
  return vec4(du * vec3(k1 + k4 * u.y + k6 * u.z + k7 * u.y * u.z, k2 + k5 * u.z + k4 * u.x + k7 * u.z * u.x,
                        k3 + k6 * u.x + k5 * u.y + k7 * u.x * u.y), value);
}
`;

const TURNED = /* glsl */ `
// Two lattices turned against each other show neither; one is enough where it is fine.
vec4 noiseOnce(vec3 x) {
  vec4 turned = latticeNoise(TURN * x);
  return vec4(transpose(TURN) * turned.xyz, turned.w);
}
vec4 noiseAt(vec3 x) {
  vec4 straight = latticeNoise(TURN * x);
  vec4 turned = latticeNoise(TURN * (TURN * x) * 1.37 + 41.0);
  return vec4(0.5 * (transpose(TURN) * straight.xyz + 1.37 * transpose(TURN * TURN) * turned.xyz), 0.5 * (straight.w + turned.w));
}
`;

const LIGHT = /* glsl */ `
const vec3 KEY = vec3(-0.4575, 0.6100, 0.6469);
const vec3 RIM = vec3(0.7303, 0.1660, -0.6627);
// Soft boxes of a theatre's lamp and of a wall beside it, as they are mirrored; edges as wide as the film is rough.
float lamps(vec3 r, float rough) {
  vec3 s = vec3(1.0, 0.0, 0.0), k = normalize(vec3(-0.42, 0.72, 0.55));
  vec3 a = normalize(cross(s, k)), b = cross(k, a);
  float ahead = dot(r, k);
  vec2 at = vec2(dot(r, b), dot(r, a)) / max(ahead, 0.05);
  vec2 in1 = smoothstep(vec2(0.34, 0.26) + rough, vec2(0.34, 0.26) - rough, abs(at));
  float box = in1.x * in1.y * step(0.05, ahead);
  float wall = smoothstep(0.45 - rough, 0.8 + rough, r.x) * smoothstep(-0.3, 0.3, r.y + 0.2);
  return box + 0.10 * wall;
}
// What capsules about the instruments take of the sky over a point.
float besideTools(vec3 p, vec3 n) {
  float open = 1.0;
  for (int i = 0; i < TOOLS; i++) {
    if (i >= toolCount) break;
    vec3 ab = toolTo[i] - toolFrom[i];
    float t = clamp(dot(p - toolFrom[i], ab) / max(dot(ab, ab), 1e-20), 0.0, 1.0);
    vec3 d = toolFrom[i] + t * ab - p;
    float far = max(length(d), 1e-9);
    float share = toolRadius[i] / far;
    open *= 1.0 - 0.75 * clamp(share * share, 0.0, 1.0) * clamp(0.35 + 0.65 * dot(d / far, n), 0.0, 1.0);
  }
  return open;
}
`;

export const FRAGMENT = /* glsl */ `
#define TOOLS 4
#include <common>
#include <clipping_planes_pars_fragment>
varying vec3 vNormal;
varying vec3 vPlace;
varying vec3 vWorld;
varying vec3 vRest;
varying vec3 vShade;
varying float vValue;
varying vec3 vTint;
varying float vMottle;
uniform vec3 rawTissue;
uniform float moisture;
uniform float coloured;
uniform sampler2D scale;
uniform float glass;
uniform int toolCount;
uniform vec3 toolFrom[TOOLS];
uniform vec3 toolTo[TOOLS];
uniform float toolRadius[TOOLS];
uniform mat3 normalMatrix;
${NOISE}
${TURNED}
${LIGHT}
void main() {
  #include <clipping_planes_fragment>
  vec3 view = normalize(-vPlace);
  vec3 n = normalize(vNormal);
  if (!gl_FrontFacing) n = -n;
  vec3 smoothNormal = n;
  float raw = clamp(vShade.z, 0.0, 1.0);
  float inside = gl_FrontFacing ? 0.0 : 1.0;
  raw = max(raw, inside);
  float sky = vShade.x * (1.0 - 0.8 * clamp(vShade.y * 1.6, 0.0, 1.0));
  vec3 base = mix(vTint, rawTissue, raw);
  float wet = moisture;
  float mottle = vMottle;
#ifdef FINE
  float texel = length(fwidth(vRest));
  vec4 broad = noiseAt(vRest * 5.0);
  vec4 middle = noiseAt(vRest * 21.0 + 7.0);
  vec4 fine = noiseOnce(vRest * 74.0 + 19.0);
  vec4 grain = noiseOnce(vRest * 190.0 + 3.0);
  float seeMiddle = 1.0 - smoothstep(0.25, 0.7, texel * 21.0);
  float seeFine = 1.0 - smoothstep(0.25, 0.7, texel * 74.0);
  float seeGrain = 1.0 - smoothstep(0.25, 0.7, texel * 190.0);
  mottle = 0.40 * broad.w + 0.35 * mix(0.5, middle.w, seeMiddle) + 0.25 * mix(0.5, fine.w, seeFine);
  vec3 gradient = 0.05 * 5.0 * 0.25 * broad.xyz + seeMiddle * 0.0068 * 21.0 * mix(0.6, 1.5, raw) * middle.xyz
                + seeFine * 0.0017 * 74.0 * mix(1.0, 2.4, raw) * fine.xyz + seeGrain * 0.00042 * 190.0 * mix(1.0, 2.5, raw) * grain.xyz;
  gradient *= (1.0 - coloured) * 0.9;
  // Slope of the relief on the screen, through the motion of the rest position from pixel to pixel (Mikkelsen 2010).
  vec3 px = dFdx(vPlace), py = dFdy(vPlace);
  float hx = dot(gradient, dFdx(vRest)), hy = dot(gradient, dFdy(vRest));
  vec3 r1 = cross(py, n), r2 = cross(n, px);
  float det = dot(px, r1);
  float perLength = length(dFdx(vRest)) / max(length(px), 1e-12);
  vec3 slope = sign(det) * (hx * r1 + hy * r2);
  n = normalize(abs(det) * perLength * n - slope);
  wet *= mix(0.55, 1.25, smoothstep(0.34, 0.66, 0.6 * broad.w + 0.4 * middle.w));
  float spots = smoothstep(0.58, 0.70, fine.w * 0.5 + middle.w * 0.5) * seeFine;
  base = mix(base, rawTissue * vec3(0.55, 0.30, 0.32), raw * 0.7 * spots); // raw tissue bleeds in spots
#else
  wet *= 0.5 + vMottle;
#endif
  // Lobules: a faint network of paler lines, darker between broad patches.
  vec3 pale = mix(base, base.rrr * vec3(1.35, 0.62, 0.47), 0.35);
  vec3 deep = base * vec3(0.72, 0.62, 0.64);
  base = mix(deep, mix(base, pale, smoothstep(0.48, 0.72, mottle)), smoothstep(0.28, 0.52, mottle));
  vec3 field = texture2D(scale, vec2(vValue, 0.5)).rgb;
  base = mix(base, field, coloured);
  wet *= 1.0 - 0.85 * coloured;
  wet *= mix(1.0, 0.55, raw);
  float tools = toolCount > 0 ? besideTools(vWorld, normalize(inverseTransformDirection(smoothNormal, viewMatrix))) : 1.0;
  sky *= tools;
  float facing = clamp(dot(n, view), 0.0, 1.0);
  float key = dot(n, KEY);
  vec3 reach = mix(vec3(0.42, 0.20, 0.15), vec3(0.25), coloured);
  vec3 lit = clamp((vec3(key) + reach) / (1.0 + reach), 0.0, 1.0);
  lit *= lit * 0.35 + 0.65;
  float rim = clamp(dot(n, RIM) * 0.6 + 0.2, 0.0, 1.0);
  // Light that a fold gets came off tissue before: what is left of it is redder.
  vec3 fold = mix(pow(vec3(max(sky, 0.02)), vec3(0.75, 1.15, 1.2)), vec3(sky), coloured);
  float up = 0.5 + 0.5 * dot(n, vec3(0.0, 0.85, 0.53));
  vec3 ambient = mix(mix(vec3(0.22, 0.19, 0.20), vec3(0.52, 0.53, 0.55), up), mix(vec3(0.55), vec3(0.78), up), coloured);
  vec3 light = ambient * fold + lit * mix(vec3(1.12, 1.06, 1.00), vec3(0.62), coloured) * mix(1.0, sky, 0.55)
             + rim * vec3(0.20, 0.22, 0.26) * fold * (1.0 - coloured);
  vec3 colour = base * light;
  vec3 half1 = normalize(view + KEY);
  float broadShine = pow(clamp(dot(n, half1), 0.0, 1.0), 18.0);
  float fresnel = 0.028 + 0.972 * pow(1.0 - facing, 5.0) * 0.55;
  colour += wet * broadShine * 0.075 * vec3(1.0, 0.93, 0.88) * sky;
#ifdef FINE
  vec3 coat = normalize(mix(n, smoothNormal, 0.22));
  vec3 mirrored = reflect(-view, coat);
  float f = 0.03 + 0.97 * pow(1.0 - clamp(dot(coat, view), 0.0, 1.0), 5.0) * 0.45;
  float gloss = lamps(mirrored, mix(0.16, 0.34, raw));
  float glint = pow(clamp(dot(coat, half1), 0.0, 1.0), 240.0);
  colour += wet * mix(1.0, sky, 0.8) * (f * (3.6 * gloss + 0.5 * smoothstep(-0.2, 1.0, mirrored.y)) + 0.25 * glint) * vec3(1.0, 0.98, 0.96);
#else
  colour += wet * 0.30 * pow(clamp(dot(n, half1), 0.0, 1.0), 90.0) * sky;
#endif
  float alpha = 1.0;
  if (glass > 0.5) {
    float edge = pow(1.0 - clamp(dot(smoothNormal, view), 0.0, 1.0), 2.2);
    alpha = (gl_FrontFacing ? 1.0 : 0.55) * mix(0.16, 0.78, edge);
    alpha = clamp(alpha + 0.25 * fresnel, 0.0, 1.0);
  }
  gl_FragColor = vec4(colour, alpha);
  #include <colorspace_fragment>
}
`;

/** The face of a body that is cut open: raw tissue, by noise of the place in space. */
export const CAP_VERTEX = /* glsl */ `
varying vec3 vRest;
varying vec3 vPlace;
varying vec3 vNormal;
uniform float perSize;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vRest = world.xyz * perSize;
  vNormal = normalMatrix * normal;
  vec4 mvPosition = viewMatrix * world;
  vPlace = mvPosition.xyz;
  gl_Position = projectionMatrix * mvPosition;
}
`;

export const CAP_FRAGMENT = /* glsl */ `
varying vec3 vRest;
varying vec3 vPlace;
varying vec3 vNormal;
uniform vec3 rawTissue;
${NOISE}
${TURNED}
void main() {
  vec3 n = normalize(vNormal);
  vec3 view = normalize(-vPlace);
  if (dot(n, view) < 0.0) n = -n;
  vec3 base = rawTissue;
  float shine = 0.02;
#ifdef FINE
  float texel = length(fwidth(vRest));
  vec4 broad = noiseAt(vRest * 9.0 + 31.0);
  vec4 middle = noiseAt(vRest * 34.0 + 5.0);
  vec4 fine = noiseAt(vRest * 96.0 + 11.0);
  float seeFine = 1.0 - smoothstep(0.25, 0.7, texel * 96.0);
  float mottle = 0.35 * broad.w + 0.40 * middle.w + 0.25 * mix(0.5, fine.w, seeFine);
  base *= mix(vec3(0.80, 0.70, 0.70), vec3(1.18, 1.16, 1.12), smoothstep(0.35, 0.65, mottle));
  // Mouths of small vessels.
  base = mix(base, base * vec3(0.62, 0.45, 0.48), smoothstep(0.66, 0.76, middle.w * 0.75 + fine.w * 0.25));
  n = normalize(n - 0.10 * (middle.xyz * 0.6 + fine.xyz * 0.5 * seeFine));
  shine = 0.05 * (0.5 + middle.w);
#endif
  float key = clamp((dot(n, vec3(-0.4575, 0.61, 0.6469)) + 0.3) / 1.3, 0.0, 1.0);
  vec3 colour = base * (vec3(0.62, 0.60, 0.60) + 0.95 * key);
  colour += shine * pow(clamp(dot(n, normalize(view + vec3(-0.4575, 0.61, 0.6469))), 0.0, 1.0), 30.0) * 2.2;
  gl_FragColor = vec4(colour, 1.0);
  #include <colorspace_fragment>
}
`;
