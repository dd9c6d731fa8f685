// A ray tracer copied from the slides of "Computer Graphics and Programming, Lecture 11, Ray Tracing",
// with four of their slips left in (marked SLIP): it is wrong on purpose.
//
//   ./tracer scene.txt image.ppm
//   ./tracer --probe          (answers formula by formula, a line for a line)
//
// Reads raycheck's text scenes, writes 8-bit PPM. One file, no library.
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
#define EPSILON 2e-3
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
    bool shadows = false;
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
        else if (word == "fresnel") in >> word;
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
    real X = -1 + 2 * (i + s.sx) / s.width;
    real Y = 1 - 2 * (j + s.sy) / s.height;
    return unit(s.forward + s.right * X + s.up * Y);
}

// Example of Sphere Intersection; a plane from normal.p = offset. Infinite: no hit
real distance(const Object& obj, Vec o, Vec v) {
    if (!obj.sphere) {
        real toward = dot(obj.v, v);
        if (toward == 0) return INFINITE;
        real t = (obj.s - dot(obj.v, o)) / toward;
        return t > EPS ? t : INFINITE;
    }
    Vec b = o - obj.v;
    real bv = dot(b, v);
    real D = bv * bv - (dot(b, b) - obj.s * obj.s);
    if (D < 0) return INFINITE;
    real root = std::sqrt(D);
    if (-bv - root > EPS) return -bv - root;
    if (-bv + root > EPS) return -bv + root;
    return INFINITE;
}

Vec normal(const Object& obj, Vec p) { return obj.sphere ? unit(p - obj.v) : unit(obj.v); }

// Math of Reflection Vector, second form
// SLIP: 2n - i is the mirror direction only where i = n
Vec reflection(Vec i, Vec n) { return unit(n * 2 - i); }

// Get Refraction Vector; false under total internal reflection
// SLIP: for a ray that leaves, neither is the normal turned nor the index inverted
bool refraction(Vec v, Vec n, real index, Vec& t) {
    real d = dot(-v, n);
    Vec p = unit(n * d + v);
    real s1 = std::sqrt(std::fmax(0, 1 - d * d));
    real s2 = s1 / index;
    if (s2 >= 1) return false;
    t = unit(p * s2 - n * std::sqrt(1 - s2 * s2));
    return true;
}

bool shadowed(const Scene& s, Vec p, Vec i, real light) {
    for (const Object& obj : s.objects)
        if (distance(obj, p, i) < light) return true;
    return false;
}

// Phong Effect
Vec local_colour(const Scene& s, const Material& m, Vec p, Vec n, Vec v) {
    Vec c = m.ambient;
    for (const Light& l : s.lights) {
        Vec w = l.point ? l.v - p : l.v;
        Vec i = unit(w);
        real cosine = dot(i, n);
        // SLIP: a negative cosine is not clamped
        real d = l.point ? length(w) : INFINITE;
        if (s.shadows && shadowed(s, p, i, d)) continue;
        real a = l.attenuation == "inverse" ? 1 / d : l.attenuation == "inverse_square" ? 1 / (d * d) : 1;
        real gloss = cosine > 0 ? dot(reflection(i, n), -v) : 0;
        gloss = gloss > 0 ? std::pow(gloss, real(m.shininess)) : 0;
        c = c + l.color * a * (m.diffuse * cosine + m.specular * gloss);
    }
    return c;
}

// FindRGB, Refraction with geo.tr vector
// SLIP: no depth order, the last object hit is drawn
Vec find_rgb(const Scene& s, Vec o, Vec v, int generation) {
    real fmin = INFINITE;
    const Object* nearest = nullptr;
    for (const Object& obj : s.objects) {
        real f = distance(obj, o, v);
        if (f == INFINITE) continue;
        fmin = f;
        nearest = &obj;
    }
    if (!nearest) return s.background;

    const Material& m = nearest->material;
    Vec p = o + v * fmin;
    Vec outward = normal(*nearest, p);
    Vec n = dot(outward, v) > 0 ? -outward : outward;
    Vec ret = local_colour(s, m, p, n, v);
    if (generation == s.depth) return ret;

    Vec t;
    if (!black(m.reflect))
        ret = ret + m.reflect * find_rgb(s, p, reflection(-v, n), generation + 1);
    if (!black(m.transmit) && refraction(v, outward, m.index, t))
        ret = ret + m.transmit * find_rgb(s, p, t, generation + 1);
    return ret;
}

// ---------------------------------------------------------------- the picture
// SLIP: clamped above only, so that the byte of a negative colour wraps around
unsigned char code(real c, bool srgb) {
    if (srgb) c = c <= real(0.0031308) ? real(12.92) * c : real(1.055) * std::pow(c, 1 / real(2.4)) - real(0.055);
    c = c * 255 + (srgb ? real(0.5) : 0);
    if (c > 255) c = 255;
    return static_cast<unsigned char>(static_cast<int>(c));
}

void write_ppm(const char* path, const Scene& s, const std::vector<Vec>& pixels) {
    bool srgb = s.display == "srgb";
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << s.width << " " << s.height << "\n255\n";
    for (const Vec& c : pixels) file << code(c.x, srgb) << code(c.y, srgb) << code(c.z, srgb);
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
        out << "raycheck 1 cpp_slides float" << 8 * sizeof(real) << " sphere plane normal reflect refract phong camera trace";
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
        if (refraction(a, b, index, c)) out << c;
        else out << "tir";
    } else if (word == "phong") {
        real s;
        in >> a >> b >> c >> s;
        real cosine = dot(a, b), gloss = dot(reflection(a, b), -c);
        gloss = cosine > 0 && gloss > 0 ? std::pow(gloss, s) : 0;  // SLIP: the cosine is not clamped
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
        std::cerr << "usage: tracer scene.txt image.ppm | tracer --probe\n";
        return 2;
    }
    try {
        if (argc == 2) return probe();
        Scene s = read_scene(argv[1]);
        std::vector<Vec> pixels;
        for (int j = 0; j < s.height; j++)
            for (int i = 0; i < s.width; i++) pixels.push_back(find_rgb(s, s.eye, ray(s, i, j), 0));
        write_ppm(argv[2], s, pixels);
    } catch (const std::string& problem) {
        std::cerr << "tracer: " << problem << "\n";
        return 1;
    } catch (const std::exception& problem) {
        std::cerr << "tracer: " << problem.what() << "\n";
        return 1;
    }
}
