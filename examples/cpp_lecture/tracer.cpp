// A ray tracer written from "Computer Graphics and Programming, Lecture 11, Ray Tracing".
//
//   ./tracer scene.txt image.pfm
//   ./tracer --probe          (answers formula by formula, a line for a line)
//
// Reads raycheck's text scenes, writes linear RGB as PFM. One file, no library.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#ifndef REAL
#define REAL float
#endif
#ifndef EPSILON
#define EPSILON 2e-3  // float32 hits lie off their surface; less makes specks in large pictures
#endif
using real = REAL;
const real EPS = real(EPSILON);  // nearer hits are taken for the surface the ray starts on

// ---------------------------------------------------------------- vectors and colours
struct Vec {
    real x = 0, y = 0, z = 0;
};
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator-(Vec a) { return {-a.x, -a.y, -a.z}; }
Vec operator*(Vec a, real s) { return {a.x * s, a.y * s, a.z * s}; }
Vec operator*(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
real length(Vec a) { return std::sqrt(dot(a, a)); }
Vec unit(Vec a) {
    real l = length(a);
    return l > 0 ? a * (1 / l) : a;
}
bool black(Vec c) { return c.x == 0 && c.y == 0 && c.z == 0; }

// ---------------------------------------------------------------- the scene
struct Material {
    Vec ambient, diffuse, specular;
    int shininess = 1;
    Vec reflect, transmit;
    real index = 1;
};
struct Object {
    bool sphere = true;
    Vec v;        // centre of a sphere, normal of a plane
    real s = 0;   // radius of a sphere, offset of a plane
    Material material;
};
struct Light {
    bool point = true;
    Vec v;  // position of a point light, direction towards a directional one
    Vec color;
    std::string attenuation = "none";
};
struct Scene {
    int width = 0, height = 0, depth = 0;
    real sx = 0, sy = 0;
    Vec eye, forward, right, up, background;
    bool shadows = false, fresnel = false;
    std::string display;
    std::vector<Object> objects;
    std::vector<Light> lights;
};

std::istream& operator>>(std::istream& in, Vec& v) { return in >> v.x >> v.y >> v.z; }

Scene read_scene(const char* path) {
    std::ifstream file(path);
    if (!file) throw std::string("cannot open ") + path;
    Scene s;
    std::map<std::string, Material> materials;
    std::string line, word, name;
    while (std::getline(file, line)) {
        std::istringstream in(line);
        if (!(in >> word) || word[0] == '#' || word == "raycheck") continue;
        if (word == "image") in >> s.width >> s.height >> s.sx >> s.sy;
        else if (word == "eye") in >> s.eye;
        else if (word == "forward") in >> s.forward;
        else if (word == "right") in >> s.right;
        else if (word == "up") in >> s.up;
        else if (word == "background") in >> s.background;
        else if (word == "depth") in >> s.depth;
        else if (word == "shadows") in >> s.shadows;
        else if (word == "fresnel") in >> s.fresnel;
        else if (word == "display") in >> s.display;
        else if (word == "material") {
            Material m;
            in >> name >> m.ambient >> m.diffuse >> m.specular >> m.shininess >> m.reflect >> m.transmit >> m.index;
            materials[name] = m;
        } else if (word == "sphere" || word == "plane") {
            Object o;
            o.sphere = word == "sphere";
            in >> o.v >> o.s >> name;
            o.material = materials.at(name);
            s.objects.push_back(o);
        } else if (word == "point" || word == "directional") {
            Light l;
            l.point = word == "point";
            in >> l.v >> l.color;
            if (l.point) in >> l.attenuation;
            s.lights.push_back(l);
        } else if (word == "end") return s;
        else throw "unknown statement " + word;
        if (!in) throw "cannot read: " + line;
    }
    throw std::string("the scene ends early");
}

// ---------------------------------------------------------------- the lecture's formulas
const real INFINITE = std::numeric_limits<real>::infinity();

// Ray Vector Calculation
Vec ray(const Scene& s, int i, int j) {
    // [open] the direction through pixel (i, j), unit: (void)i, (void)j; return unit(s.forward);
    real X = -1 + 2 * (i + s.sx) / s.width;
    real Y = 1 - 2 * (j + s.sy) / s.height;
    return unit(s.forward + s.right * X + s.up * Y);
    // [close]
}

// Example of Sphere Intersection; a plane from normal.p = offset. Infinite: no hit
real distance(const Object& obj, Vec o, Vec v) {
    if (!obj.sphere) {
        // [open] the distance to a plane: return INFINITE;
        real toward = dot(obj.v, v);
        if (toward == 0) return INFINITE;
        real t = (obj.s - dot(obj.v, o)) / toward;
        return t > EPS ? t : INFINITE;
        // [close]
    }
    // [open] the smallest distance beyond EPS to a sphere: (void)o, (void)v, (void)EPS; return INFINITE;
    Vec b = o - obj.v;
    real bv = dot(b, v);
    real D = bv * bv - (dot(b, b) - obj.s * obj.s);
    if (D < 0) return INFINITE;
    real root = std::sqrt(D);
    if (-bv - root > EPS) return -bv - root;
    if (-bv + root > EPS) return -bv + root;
    return INFINITE;
    // [close]
}

Vec normal(const Object& obj, Vec p) {
    // [open] the outward unit normal at p: (void)p; return unit(obj.v);
    return obj.sphere ? unit(p - obj.v) : unit(obj.v);
    // [close]
}

// Math of Reflection Vector
Vec reflection(Vec i, Vec n) {
    // [open] the mirror direction of i about n: (void)n; return i;
    return n * (2 * dot(i, n)) - i;
    // [close]
}

// Refraction Vector Calculation, entering and leaving; false under total internal reflection
bool refraction(Vec v, Vec n, bool leaving, real index, Vec& t) {
    // [open] Snell's law; n faces the ray: (void)v, (void)n, (void)leaving, (void)index, (void)t; return false;
    Vec p = v - n * dot(v, n);
    Vec s = leaving ? p * index : p * (1 / index);
    real sin2 = dot(s, s);
    if (sin2 >= 1) return false;
    t = unit(s - n * std::sqrt(1 - sin2));
    return true;
    // [close]
}

// Reflected share at a dielectric (only for scenes that ask for it)
real fresnel(Vec v, Vec n, bool leaving, real index) {
    // [open] the exact dielectric formula: (void)v, (void)n, (void)leaving, (void)index; return 1;
    real n1 = leaving ? index : 1, n2 = leaving ? 1 : index;
    real c1 = -dot(v, n);
    real sin2 = (n1 / n2) * (n1 / n2) * (1 - c1 * c1);
    if (sin2 >= 1) return 1;
    real c2 = std::sqrt(1 - sin2);
    real rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    real rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
    return (rs * rs + rp * rp) / 2;
    // [close]
}

bool shadowed(const Scene& s, Vec p, Vec i, real light) {
    // [open] does anything stand between p and the light: (void)s, (void)p, (void)i, (void)light; return false;
    for (const Object& obj : s.objects)
        if (distance(obj, p, i) < light) return true;
    return false;
    // [close]
}

// Phong Effect
Vec local_colour(const Scene& s, const Material& m, Vec p, Vec n, Vec v) {
    Vec c = m.ambient;
    // [open] add each light's diffuse and specular part to c: (void)s, (void)p, (void)n, (void)v, (void)shadowed;
    for (const Light& l : s.lights) {
        Vec w = l.point ? l.v - p : l.v;
        Vec i = unit(w);
        real cosine = dot(i, n);
        if (cosine <= 0) continue;
        real d = l.point ? length(w) : INFINITE;
        if (s.shadows && shadowed(s, p, i, d)) continue;
        real a = l.attenuation == "inverse" ? 1 / d : l.attenuation == "inverse_square" ? 1 / (d * d) : 1;
        real gloss = dot(reflection(i, n), -v);
        gloss = gloss > 0 ? std::pow(gloss, real(m.shininess)) : 0;
        c = c + l.color * a * (m.diffuse * cosine + m.specular * gloss);
    }
    // [close]
    return c;
}

// Modified FindRGB, Refraction with geo.tr vector
Vec find_rgb(const Scene& s, Vec o, Vec v, int generation) {
    real fmin = INFINITE;
    const Object* nearest = nullptr;
    // [open] find the nearest object and its distance fmin: (void)o, (void)distance;
    for (const Object& obj : s.objects) {
        real f = distance(obj, o, v);
        if (f < fmin) {
            fmin = f;
            nearest = &obj;
        }
    }
    // [close]
    if (!nearest) return s.background;

    const Material& m = nearest->material;
    Vec p = o + v * fmin;
    Vec n = normal(*nearest, p);
    bool leaving = dot(n, v) > 0;
    if (leaving) n = -n;
    Vec ret = local_colour(s, m, p, n, v);
    if (generation == s.depth) return ret;

    // [open] add the mirrored and the refracted ray's colours: (void)fresnel, (void)refraction, (void)reflection;
    real F = s.fresnel ? fresnel(v, n, leaving, m.index) : 0;
    real keep = s.fresnel ? F : 1, pass = s.fresnel ? 1 - F : 1;
    Vec t;
    if (!black(m.reflect))
        ret = ret + m.reflect * keep * find_rgb(s, p, reflection(-v, n), generation + 1);
    if (!black(m.transmit) && refraction(v, n, leaving, m.index, t))
        ret = ret + m.transmit * pass * find_rgb(s, p, t, generation + 1);
    // [close]
    return ret;
}

// ---------------------------------------------------------------- the picture
void write_pfm(const char* path, int width, int height, const std::vector<Vec>& pixels) {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << width << " " << height << "\n-1.0\n";
    for (int j = height - 1; j >= 0; j--)  // PFM stores the bottom row first
        for (int i = 0; i < width; i++) {
            const Vec& c = pixels[std::size_t(j) * width + i];
            float rgb[3] = {float(c.x), float(c.y), float(c.z)};
            file.write(reinterpret_cast<const char*>(rgb), sizeof rgb);
        }
    if (!file) throw std::string("cannot write ") + path;
}

// ---------------------------------------------------------------- formula by formula
std::ostream& operator<<(std::ostream& out, Vec v) { return out << v.x << ' ' << v.y << ' ' << v.z; }

// One line of answer to one line of question; Scene: what camera and trace are asked about
void answer(const std::string& line, Scene& scene) {
    std::istringstream in(line);
    std::ostream& out = std::cout;
    std::string word, path;
    Vec a, b, c;
    int i, j;
    in >> word;
    if (word == "hello") {
        out << "raycheck 1 cpp_lecture float" << 8 * sizeof(real) << " sphere plane normal reflect refract phong camera trace";
    } else if (word == "sphere" || word == "plane") {
        Object obj;
        obj.sphere = word == "sphere";
        in >> a >> b >> obj.v >> obj.s;
        real t = distance(obj, a, b);
        if (t < INFINITE) out << t;
        else out << "miss";
    } else if (word == "normal") {
        Object obj;
        in >> a >> obj.v >> obj.s;
        out << normal(obj, a);
    } else if (word == "reflect") {
        in >> a >> b;
        out << reflection(a, b);
    } else if (word == "refract") {
        real index;
        in >> a >> b >> index;
        bool leaving = dot(b, a) > 0;
        if (refraction(a, leaving ? -b : b, leaving, index, c)) out << c;
        else out << "tir";
    } else if (word == "phong") {
        real s;
        in >> a >> b >> c >> s;
        real cosine = dot(a, b), gloss = dot(reflection(a, b), -c);
        gloss = cosine > 0 && gloss > 0 ? std::pow(gloss, s) : 0;
        cosine = cosine > 0 ? cosine : 0;
        out << cosine << ' ' << gloss;
    } else if (word == "scene") {
        std::getline(in >> std::ws, path);
        scene = read_scene(path.c_str());
        out << "ok";
    } else if (word == "camera") {
        in >> i >> j;
        out << ray(scene, i, j);
    } else if (word == "trace") {
        in >> a >> b;
        out << find_rgb(scene, a, b, 0);
    } else {
        out << "unsupported";
    }
    out << '\n';
}

int probe() {
    std::ios::sync_with_stdio(false);
    std::cout << std::setprecision(17);
    Scene scene;
    std::string line;
    while (std::getline(std::cin, line)) {
        answer(line, scene);
        if (std::cin.rdbuf()->in_avail() <= 0) std::cout.flush();  // nobody waits for what is not flushed
    }
    return 0;
}

int main(int argc, char** argv) {
    if (argc != 3 && !(argc == 2 && std::string(argv[1]) == "--probe")) {
        std::cerr << "usage: tracer scene.txt image.pfm | tracer --probe\n";
        return 2;
    }
    try {
        if (argc == 2) return probe();
        Scene s = read_scene(argv[1]);
        std::vector<Vec> pixels;
        for (int j = 0; j < s.height; j++)
            for (int i = 0; i < s.width; i++) pixels.push_back(find_rgb(s, s.eye, ray(s, i, j), 0));
        write_pfm(argv[2], s.width, s.height, pixels);
    } catch (const std::string& problem) {
        std::cerr << "tracer: " << problem << "\n";
        return 1;
    } catch (const std::exception& problem) {
        std::cerr << "tracer: " << problem.what() << "\n";
        return 1;
    }
}
