// A ray tracer written from "Computer Graphics and Programming, Lecture 11, Ray Tracing".
//
//   node tracer.js scene.txt image.pfm
//
// Reads raycheck's text scenes, writes linear RGB as PFM. One file, no library.
"use strict";
const fs = require("fs");

const EPS = 2e-3; // nearer hits are taken for the surface the ray starts on

// ---------------------------------------------------------------- vectors and colours
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const neg = (a) => [-a[0], -a[1], -a[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const mul = (a, b) => [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const length = (a) => Math.sqrt(dot(a, a));
const unit = (a) => {
  const size = length(a);
  return size > 0 ? scale(a, 1 / size) : a;
};
const black = (c) => c[0] === 0 && c[1] === 0 && c[2] === 0;

// ---------------------------------------------------------------- the scene
function readScene(path) {
  const s = { objects: [], lights: [] };
  const materials = new Map();
  for (const line of fs.readFileSync(path, "utf8").split("\n")) {
    const [word, ...rest] = line.split(/\s+/).filter(Boolean);
    if (word === undefined || word.startsWith("#") || word === "raycheck" || word === "display") continue;
    const n = rest.map(Number);
    if (word === "image") [s.width, s.height, s.sx, s.sy] = n;
    else if (["eye", "forward", "right", "up", "background"].includes(word)) s[word] = n;
    else if (["depth", "shadows", "fresnel"].includes(word)) s[word] = n[0];
    else if (word === "material")
      materials.set(rest[0], {
        ambient: n.slice(1, 4), diffuse: n.slice(4, 7), specular: n.slice(7, 10), shininess: n[10],
        reflect: n.slice(11, 14), transmit: n.slice(14, 17), index: n[17],
      });
    else if (word === "sphere" || word === "plane")
      // v: centre of a sphere, normal of a plane; s: radius of a sphere, offset of a plane
      s.objects.push({ sphere: word === "sphere", v: n.slice(0, 3), s: n[3], material: materials.get(rest[4]) });
    else if (word === "point" || word === "directional")
      // v: position of a point light, direction towards a directional one
      s.lights.push({ point: word === "point", v: n.slice(0, 3), color: n.slice(3, 6), attenuation: rest[6] ?? "none" });
    else if (word === "end") return s;
    else throw new Error(`unknown statement ${word}`);
  }
  throw new Error("the scene ends early");
}

// ---------------------------------------------------------------- the lecture's formulas
// Ray Vector Calculation
function ray(s, i, j) {
  // [open] the direction through pixel (i, j), unit: return s.forward;
  const X = -1 + (2 * (i + s.sx)) / s.width;
  const Y = 1 - (2 * (j + s.sy)) / s.height;
  return unit(add(s.forward, add(scale(s.right, X), scale(s.up, Y))));
  // [close]
}

// Sphere Intersection; a plane from normal.p = offset. Infinity: no hit
function distance(object, o, v) {
  if (!object.sphere) {
    // [open] the distance to a plane: return Infinity;
    const toward = dot(object.v, v);
    if (toward === 0) return Infinity;
    const t = (object.s - dot(object.v, o)) / toward;
    return t > EPS ? t : Infinity;
    // [close]
  }
  // [open] the smallest distance beyond EPS to a sphere: return Infinity;
  const b = sub(o, object.v);
  const bv = dot(b, v);
  const D = bv * bv - (dot(b, b) - object.s * object.s);
  if (D < 0) return Infinity;
  const root = Math.sqrt(D);
  if (-bv - root > EPS) return -bv - root;
  if (-bv + root > EPS) return -bv + root;
  return Infinity;
  // [close]
}

function normal(object, p) {
  // [open] the outward unit normal at p: return [0, 0, 1];
  return object.sphere ? unit(sub(p, object.v)) : unit(object.v);
  // [close]
}

// Math of Reflection Vector
function reflection(i, n) {
  // [open] the mirror direction of i about n: return i;
  return sub(scale(n, 2 * dot(i, n)), i);
  // [close]
}

// Refraction Vector Calculation, entering and leaving; null under total internal reflection
function refraction(v, n, leaving, index) {
  // [open] Snell's law; n faces the ray: return null;
  const p = sub(v, scale(n, dot(v, n)));
  const s = scale(p, leaving ? index : 1 / index);
  const sin2 = dot(s, s);
  return sin2 >= 1 ? null : unit(sub(s, scale(n, Math.sqrt(1 - sin2))));
  // [close]
}

// Reflected share at a dielectric (only for scenes that ask for it)
function fresnel(v, n, leaving, index) {
  // [open] the exact dielectric formula: return 1;
  const [n1, n2] = leaving ? [index, 1] : [1, index];
  const c1 = -dot(v, n);
  const sin2 = (n1 / n2) * (n1 / n2) * (1 - c1 * c1);
  if (sin2 >= 1) return 1;
  const c2 = Math.sqrt(1 - sin2);
  const rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
  const rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
  return (rs * rs + rp * rp) / 2;
  // [close]
}

function shadowed(s, p, i, light) {
  // [open] does anything stand between p and the light: return false;
  return s.objects.some((object) => distance(object, p, i) < light);
  // [close]
}

// Phong Effect
function localColour(s, m, p, n, v) {
  let c = m.ambient;
  // [open] add each light's diffuse and specular part to c: c = add(c, [0, 0, 0]);
  for (const l of s.lights) {
    const w = l.point ? sub(l.v, p) : l.v;
    const i = unit(w);
    const cosine = dot(i, n);
    if (cosine <= 0) continue;
    const d = l.point ? length(w) : Infinity;
    if (s.shadows && shadowed(s, p, i, d)) continue;
    const a = { none: 1, inverse: 1 / d, inverse_square: 1 / (d * d) }[l.attenuation];
    const mirrored = dot(reflection(i, n), neg(v));
    const gloss = mirrored > 0 ? mirrored ** m.shininess : 0;
    c = add(c, mul(scale(l.color, a), add(scale(m.diffuse, cosine), scale(m.specular, gloss))));
  }
  // [close]
  return c;
}

// Modified FindRGB, Refraction with geo.tr vector
function findRGB(s, o, v, generation) {
  let nearest = null, fmin = Infinity;
  // [open] find the nearest object and its distance fmin: fmin = Infinity;
  for (const object of s.objects) {
    const f = distance(object, o, v);
    if (f < fmin) [nearest, fmin] = [object, f];
  }
  // [close]
  if (nearest === null) return s.background;

  const m = nearest.material;
  const p = add(o, scale(v, fmin));
  let n = normal(nearest, p);
  const leaving = dot(n, v) > 0;
  if (leaving) n = neg(n);
  let colour = localColour(s, m, p, n, v);
  if (generation === s.depth) return colour;

  // [open] add the mirrored and the refracted ray's colours: colour = add(colour, [0, 0, 0]);
  const share = s.fresnel ? fresnel(v, n, leaving, m.index) : null;
  if (!black(m.reflect)) {
    const mirrored = findRGB(s, p, reflection(neg(v), n), generation + 1);
    colour = add(colour, scale(mul(m.reflect, mirrored), share ?? 1));
  }
  if (!black(m.transmit)) {
    const t = refraction(v, n, leaving, m.index);
    if (t !== null)
      colour = add(colour, scale(mul(m.transmit, findRGB(s, p, t, generation + 1)), share === null ? 1 : 1 - share));
  }
  // [close]
  return colour;
}

// ---------------------------------------------------------------- the picture
function writePFM(path, width, height, pixels) {
  const header = Buffer.from(`PF\n${width} ${height}\n-1.0\n`, "ascii");
  const body = Buffer.alloc(12 * width * height);
  let at = 0;
  for (let j = height - 1; j >= 0; j--) // PFM stores the bottom row first
    for (let i = 0; i < width; i++) for (const value of pixels[j * width + i]) at = body.writeFloatLE(value, at);
  fs.writeFileSync(path, Buffer.concat([header, body]));
}

if (process.argv.length !== 4) {
  console.error("usage: node tracer.js scene.txt image.pfm");
  process.exit(2);
}
const scene = readScene(process.argv[2]);
const pixels = [];
for (let j = 0; j < scene.height; j++)
  for (let i = 0; i < scene.width; i++) pixels.push(findRGB(scene, scene.eye, ray(scene, i, j), 0));
writePFM(process.argv[3], scene.width, scene.height, pixels);
