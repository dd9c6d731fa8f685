// A ray tracer written from "Computer Graphics and Programming, Lecture 11, Ray Tracing".
//
//   ./tracer scene.txt image.pfm
//
// Reads raycheck's text scenes, writes linear RGB as PFM. One file, no crate.
use std::collections::HashMap;
use std::fs;
use std::io::Write;
use std::ops::{Add, Mul, Neg, Sub};

type Real = f32;
const EPS: Real = 2e-3; // nearer hits are taken for the surface the ray starts on
const INFINITE: Real = Real::INFINITY;

// ---------------------------------------------------------------- vectors and colours
#[derive(Clone, Copy, Default)]
struct Vec3 {
    x: Real,
    y: Real,
    z: Real,
}
fn vec3(n: &[Real]) -> Vec3 {
    Vec3 { x: n[0], y: n[1], z: n[2] }
}
impl Add for Vec3 {
    type Output = Vec3;
    fn add(self, b: Vec3) -> Vec3 {
        Vec3 { x: self.x + b.x, y: self.y + b.y, z: self.z + b.z }
    }
}
impl Sub for Vec3 {
    type Output = Vec3;
    fn sub(self, b: Vec3) -> Vec3 {
        Vec3 { x: self.x - b.x, y: self.y - b.y, z: self.z - b.z }
    }
}
impl Neg for Vec3 {
    type Output = Vec3;
    fn neg(self) -> Vec3 {
        Vec3 { x: -self.x, y: -self.y, z: -self.z }
    }
}
impl Mul<Real> for Vec3 {
    type Output = Vec3;
    fn mul(self, s: Real) -> Vec3 {
        Vec3 { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}
impl Mul for Vec3 {
    type Output = Vec3;
    fn mul(self, b: Vec3) -> Vec3 {
        Vec3 { x: self.x * b.x, y: self.y * b.y, z: self.z * b.z }
    }
}
fn dot(a: Vec3, b: Vec3) -> Real {
    a.x * b.x + a.y * b.y + a.z * b.z
}
fn length(a: Vec3) -> Real {
    dot(a, a).sqrt()
}
fn unit(a: Vec3) -> Vec3 {
    let l = length(a);
    if l > 0.0 { a * (1.0 / l) } else { a }
}
fn black(c: Vec3) -> bool {
    c.x == 0.0 && c.y == 0.0 && c.z == 0.0
}

// ---------------------------------------------------------------- the scene
#[derive(Clone, Default)]
struct Material {
    ambient: Vec3,
    diffuse: Vec3,
    specular: Vec3,
    shininess: Real,
    reflect: Vec3,
    transmit: Vec3,
    index: Real,
}
struct Object {
    sphere: bool,
    v: Vec3, // centre of a sphere, normal of a plane
    s: Real, // radius of a sphere, offset of a plane
    material: Material,
}
struct Light {
    point: bool,
    v: Vec3, // position of a point light, direction towards a directional one
    color: Vec3,
    attenuation: String,
}
#[derive(Default)]
struct Scene {
    width: usize,
    height: usize,
    sx: Real,
    sy: Real,
    eye: Vec3,
    forward: Vec3,
    right: Vec3,
    up: Vec3,
    background: Vec3,
    depth: i32,
    shadows: bool,
    fresnel: bool,
    objects: Vec<Object>,
    lights: Vec<Light>,
}

fn numbers(words: &[&str]) -> Result<Vec<Real>, String> {
    words.iter().map(|w| w.parse::<Real>().map_err(|e| format!("{w}: {e}"))).collect()
}

fn read_scene(path: &str) -> Result<Scene, String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{path}: {e}"))?;
    let mut s = Scene::default();
    let mut materials: HashMap<String, Material> = HashMap::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words.is_empty() || words[0].starts_with('#') {
            continue;
        }
        let rest = &words[1..];
        match words[0] {
            "raycheck" | "display" => {}
            "image" => {
                let n = numbers(rest)?;
                (s.width, s.height, s.sx, s.sy) = (n[0] as usize, n[1] as usize, n[2], n[3]);
            }
            "eye" => s.eye = vec3(&numbers(rest)?),
            "forward" => s.forward = vec3(&numbers(rest)?),
            "right" => s.right = vec3(&numbers(rest)?),
            "up" => s.up = vec3(&numbers(rest)?),
            "background" => s.background = vec3(&numbers(rest)?),
            "depth" => s.depth = numbers(rest)?[0] as i32,
            "shadows" => s.shadows = rest[0] == "1",
            "fresnel" => s.fresnel = rest[0] == "1",
            "material" => {
                let n = numbers(&rest[1..])?;
                let m = Material {
                    ambient: vec3(&n[0..]),
                    diffuse: vec3(&n[3..]),
                    specular: vec3(&n[6..]),
                    shininess: n[9],
                    reflect: vec3(&n[10..]),
                    transmit: vec3(&n[13..]),
                    index: n[16],
                };
                materials.insert(rest[0].to_string(), m);
            }
            "sphere" | "plane" => {
                let n = numbers(&rest[..4])?;
                let material = materials.get(rest[4]).ok_or("unknown material")?.clone();
                s.objects.push(Object { sphere: words[0] == "sphere", v: vec3(&n), s: n[3], material });
            }
            "point" | "directional" => {
                let n = numbers(&rest[..6])?;
                let attenuation = rest.get(6).unwrap_or(&"none").to_string();
                s.lights.push(Light { point: words[0] == "point", v: vec3(&n), color: vec3(&n[3..]), attenuation });
            }
            "end" => return Ok(s),
            word => return Err(format!("unknown statement {word}")),
        }
    }
    Err("the scene ends early".to_string())
}

// ---------------------------------------------------------------- the lecture's formulas
// Ray Vector Calculation
fn ray(s: &Scene, i: usize, j: usize) -> Vec3 {
    // [open] the direction through pixel (i, j), unit: let _ = (i, j, s.sx, s.sy); unit(s.forward)
    let x = -1.0 + 2.0 * (i as Real + s.sx) / s.width as Real;
    let y = 1.0 - 2.0 * (j as Real + s.sy) / s.height as Real;
    unit(s.forward + s.right * x + s.up * y)
    // [close]
}

// Sphere Intersection; a plane from normal.p = offset. Infinite: no hit
fn distance(object: &Object, o: Vec3, v: Vec3) -> Real {
    if !object.sphere {
        // [open] the distance to a plane: let _ = (o, v, object.v, EPS); return INFINITE;
        let toward = dot(object.v, v);
        if toward == 0.0 {
            return INFINITE;
        }
        let t = (object.s - dot(object.v, o)) / toward;
        return if t > EPS { t } else { INFINITE };
        // [close]
    }
    // [open] the smallest distance beyond EPS to a sphere: INFINITE
    let b = o - object.v;
    let bv = dot(b, v);
    let d = bv * bv - (dot(b, b) - object.s * object.s);
    if d < 0.0 {
        return INFINITE;
    }
    let root = d.sqrt();
    if -bv - root > EPS {
        -bv - root
    } else if -bv + root > EPS {
        -bv + root
    } else {
        INFINITE
    }
    // [close]
}

fn normal(object: &Object, p: Vec3) -> Vec3 {
    // [open] the outward unit normal at p: let _ = p; unit(object.v)
    if object.sphere { unit(p - object.v) } else { unit(object.v) }
    // [close]
}

// Math of Reflection Vector
fn reflection(i: Vec3, n: Vec3) -> Vec3 {
    // [open] the mirror direction of i about n: let _ = n; i
    n * (2.0 * dot(i, n)) - i
    // [close]
}

// Refraction Vector Calculation, entering and leaving; None under total internal reflection
fn refraction(v: Vec3, n: Vec3, leaving: bool, index: Real) -> Option<Vec3> {
    // [open] Snell's law; n faces the ray: let _ = (v, n, leaving, index); None
    let p = v - n * dot(v, n);
    let s = if leaving { p * index } else { p * (1.0 / index) };
    let sin2 = dot(s, s);
    if sin2 >= 1.0 {
        return None;
    }
    Some(unit(s - n * (1.0 - sin2).sqrt()))
    // [close]
}

// Reflected share at a dielectric (only for scenes that ask for it)
fn fresnel(v: Vec3, n: Vec3, leaving: bool, index: Real) -> Real {
    // [open] the exact dielectric formula: let _ = (v, n, leaving, index); 1.0
    let (n1, n2) = if leaving { (index, 1.0) } else { (1.0, index) };
    let c1 = -dot(v, n);
    let sin2 = (n1 / n2) * (n1 / n2) * (1.0 - c1 * c1);
    if sin2 >= 1.0 {
        return 1.0;
    }
    let c2 = (1.0 - sin2).sqrt();
    let rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    let rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    (rs * rs + rp * rp) / 2.0
    // [close]
}

fn shadowed(s: &Scene, p: Vec3, i: Vec3, light: Real) -> bool {
    // [open] does anything stand between p and the light: let _ = (s, p, i, light); false
    s.objects.iter().any(|object| distance(object, p, i) < light)
    // [close]
}

// Phong Effect
fn local_colour(s: &Scene, m: &Material, p: Vec3, n: Vec3, v: Vec3) -> Vec3 {
    #[allow(unused_mut)]
    let mut c = m.ambient;
    for l in &s.lights {
        let w = if l.point { l.v - p } else { l.v };
        let i = unit(w);
        let d = if l.point { length(w) } else { INFINITE };
        let a = match l.attenuation.as_str() {
            "inverse" => 1.0 / d,
            "inverse_square" => 1.0 / (d * d),
            _ => 1.0,
        };
        let light = l.color * a;
        // [open] add this light's diffuse and specular part to c: let _ = (light, shadowed(s, p, i, d), m.diffuse, m.specular, m.shininess, n, v);
        let cosine = dot(i, n);
        if cosine <= 0.0 || (s.shadows && shadowed(s, p, i, d)) {
            continue;
        }
        let gloss = dot(reflection(i, n), -v);
        let gloss = if gloss > 0.0 { gloss.powf(m.shininess) } else { 0.0 };
        c = c + light * (m.diffuse * cosine + m.specular * gloss);
        // [close]
    }
    c
}

// Modified FindRGB, Refraction with geo.tr vector
fn find_rgb(s: &Scene, o: Vec3, v: Vec3, generation: i32) -> Vec3 {
    #[allow(unused_mut)]
    let mut nearest: Option<(&Object, Real)> = None;
    for object in &s.objects {
        let f = distance(object, o, v);
        // [open] keep the nearest object and its distance: let _ = f;
        if f < nearest.map_or(INFINITE, |(_, fmin)| fmin) {
            nearest = Some((object, f));
        }
        // [close]
    }
    let Some((object, fmin)) = nearest else { return s.background };

    let m = &object.material;
    let p = o + v * fmin;
    let mut n = normal(object, p);
    let leaving = dot(n, v) > 0.0;
    if leaving {
        n = -n;
    }
    #[allow(unused_mut)]
    let mut colour = local_colour(s, m, p, n, v);
    if generation == s.depth {
        return colour;
    }

    let share = if s.fresnel { Some(fresnel(v, n, leaving, m.index)) } else { None };
    let (keep, pass) = share.map_or((1.0, 1.0), |f| (f, 1.0 - f));
    if !black(m.reflect) {
        let r = reflection(-v, n);
        // [open] add the mirrored ray's colour: let _ = (r, keep);
        colour = colour + m.reflect * keep * find_rgb(s, p, r, generation + 1);
        // [close]
    }
    if !black(m.transmit) {
        if let Some(t) = refraction(v, n, leaving, m.index) {
            // [open] add the refracted ray's colour: let _ = (t, pass, m.transmit);
            colour = colour + m.transmit * pass * find_rgb(s, p, t, generation + 1);
            // [close]
        }
    }
    colour
}

// ---------------------------------------------------------------- the picture
fn write_pfm(path: &str, width: usize, height: usize, pixels: &[Vec3]) -> std::io::Result<()> {
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    for j in (0..height).rev() {
        // PFM stores the bottom row first
        for c in &pixels[j * width..(j + 1) * width] {
            for value in [c.x, c.y, c.z] {
                bytes.extend(value.to_le_bytes());
            }
        }
    }
    fs::File::create(path)?.write_all(&bytes)
}

fn run(scene: &str, image: &str) -> Result<(), String> {
    let s = read_scene(scene)?;
    let mut pixels = Vec::with_capacity(s.width * s.height);
    for j in 0..s.height {
        for i in 0..s.width {
            pixels.push(find_rgb(&s, s.eye, ray(&s, i, j), 0));
        }
    }
    write_pfm(image, s.width, s.height, &pixels).map_err(|e| format!("{image}: {e}"))
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    if words.len() != 3 {
        eprintln!("usage: tracer scene.txt image.pfm");
        std::process::exit(2);
    }
    if let Err(problem) = run(&words[1], &words[2]) {
        eprintln!("tracer: {problem}");
        std::process::exit(1);
    }
}
