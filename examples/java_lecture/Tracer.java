// A ray tracer written from "Computer Graphics and Programming, Lecture 11, Ray Tracing".
//
//   java Tracer scene.txt image.pfm
//
// Reads raycheck's text scenes, writes linear RGB as PFM. One file, no library.
import java.io.IOException;
import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.HashMap;
import java.util.List;
import java.util.Map;

public final class Tracer {
    static final float EPS = 2e-3f; // nearer hits are taken for the surface the ray starts on
    static final float INFINITE = Float.POSITIVE_INFINITY;

    // ------------------------------------------------------------ vectors and colours
    record Vec(float x, float y, float z) {
        Vec plus(Vec b) { return new Vec(x + b.x, y + b.y, z + b.z); }
        Vec minus(Vec b) { return new Vec(x - b.x, y - b.y, z - b.z); }
        Vec negated() { return new Vec(-x, -y, -z); }
        Vec times(float s) { return new Vec(x * s, y * s, z * s); }
        Vec times(Vec b) { return new Vec(x * b.x, y * b.y, z * b.z); }
        float dot(Vec b) { return x * b.x + y * b.y + z * b.z; }
        float length() { return root(dot(this)); }
        Vec unit() {
            float l = length();
            return l > 0 ? times(1 / l) : this;
        }
        boolean black() { return x == 0 && y == 0 && z == 0; }
    }

    static float root(float x) { return (float) Math.sqrt(x); }

    // ------------------------------------------------------------ the scene
    record Material(Vec ambient, Vec diffuse, Vec specular, int shininess, Vec reflect, Vec transmit, float index) {}

    /** v: centre of a sphere, normal of a plane; s: radius of a sphere, offset of a plane. */
    record Thing(boolean sphere, Vec v, float s, Material material) {}

    /** v: position of a point light, direction towards a directional one. */
    record Light(boolean point, Vec v, Vec color, String attenuation) {}

    static final class Scene {
        int width, height, depth;
        float sx, sy;
        Vec eye, forward, right, up, background;
        boolean shadows, fresnel;
        final List<Thing> things = new ArrayList<>();
        final List<Light> lights = new ArrayList<>();
    }

    static Vec vector(String[] w, int at) {
        return new Vec(Float.parseFloat(w[at]), Float.parseFloat(w[at + 1]), Float.parseFloat(w[at + 2]));
    }

    static Scene readScene(Path path) throws IOException {
        Scene s = new Scene();
        Map<String, Material> materials = new HashMap<>();
        for (String line : Files.readAllLines(path, StandardCharsets.UTF_8)) {
            String[] w = line.trim().split("\\s+");
            if (w[0].isEmpty() || w[0].startsWith("#")) continue;
            switch (w[0]) {
                case "raycheck", "display" -> { }
                case "image" -> {
                    s.width = Integer.parseInt(w[1]);
                    s.height = Integer.parseInt(w[2]);
                    s.sx = Float.parseFloat(w[3]);
                    s.sy = Float.parseFloat(w[4]);
                }
                case "eye" -> s.eye = vector(w, 1);
                case "forward" -> s.forward = vector(w, 1);
                case "right" -> s.right = vector(w, 1);
                case "up" -> s.up = vector(w, 1);
                case "background" -> s.background = vector(w, 1);
                case "depth" -> s.depth = Integer.parseInt(w[1]);
                case "shadows" -> s.shadows = w[1].equals("1");
                case "fresnel" -> s.fresnel = w[1].equals("1");
                case "material" -> materials.put(w[1], new Material(
                    vector(w, 2), vector(w, 5), vector(w, 8), Integer.parseInt(w[11]),
                    vector(w, 12), vector(w, 15), Float.parseFloat(w[18])));
                case "sphere", "plane" -> s.things.add(new Thing(
                    w[0].equals("sphere"), vector(w, 1), Float.parseFloat(w[4]), materials.get(w[5])));
                case "point" -> s.lights.add(new Light(true, vector(w, 1), vector(w, 4), w[7]));
                case "directional" -> s.lights.add(new Light(false, vector(w, 1), vector(w, 4), "none"));
                case "end" -> { return s; }
                default -> throw new IOException("unknown statement " + w[0]);
            }
        }
        throw new IOException("the scene ends early");
    }

    // ------------------------------------------------------------ the lecture's formulas
    /** Ray Vector Calculation. */
    static Vec ray(Scene s, int i, int j) {
        // [open] the direction through pixel (i, j), unit: return s.forward.unit();
        float x = -1 + 2 * (i + s.sx) / s.width;
        float y = 1 - 2 * (j + s.sy) / s.height;
        return s.forward.plus(s.right.times(x)).plus(s.up.times(y)).unit();
        // [close]
    }

    /** Sphere Intersection; a plane from normal.p = offset. Infinite: no hit. */
    static float distance(Thing thing, Vec o, Vec v) {
        if (!thing.sphere) {
            // [open] the distance to a plane: return INFINITE;
            float toward = thing.v.dot(v);
            if (toward == 0) return INFINITE;
            float t = (thing.s - thing.v.dot(o)) / toward;
            return t > EPS ? t : INFINITE;
            // [close]
        }
        // [open] the smallest distance beyond EPS to a sphere: return INFINITE;
        Vec b = o.minus(thing.v);
        float bv = b.dot(v);
        float d = bv * bv - (b.dot(b) - thing.s * thing.s);
        if (d < 0) return INFINITE;
        float root = root(d);
        if (-bv - root > EPS) return -bv - root;
        if (-bv + root > EPS) return -bv + root;
        return INFINITE;
        // [close]
    }

    static Vec normal(Thing thing, Vec p) {
        // [open] the outward unit normal at p: return new Vec(0, 0, 1);
        return thing.sphere ? p.minus(thing.v).unit() : thing.v.unit();
        // [close]
    }

    /** Math of Reflection Vector. */
    static Vec reflection(Vec i, Vec n) {
        // [open] the mirror direction of i about n: return i;
        return n.times(2 * i.dot(n)).minus(i);
        // [close]
    }

    /** Refraction Vector Calculation, entering and leaving; null under total internal reflection. */
    static Vec refraction(Vec v, Vec n, boolean leaving, float index) {
        // [open] Snell's law; n faces the ray: return null;
        Vec p = v.minus(n.times(v.dot(n)));
        Vec s = leaving ? p.times(index) : p.times(1 / index);
        float sin2 = s.dot(s);
        if (sin2 >= 1) return null;
        return s.minus(n.times(root(1 - sin2))).unit();
        // [close]
    }

    /** Reflected share at a dielectric (only for scenes that ask for it). */
    static float fresnel(Vec v, Vec n, boolean leaving, float index) {
        // [open] the exact dielectric formula: return 1;
        float n1 = leaving ? index : 1, n2 = leaving ? 1 : index;
        float c1 = -v.dot(n);
        float sin2 = (n1 / n2) * (n1 / n2) * (1 - c1 * c1);
        if (sin2 >= 1) return 1;
        float c2 = root(1 - sin2);
        float rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
        float rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
        return (rs * rs + rp * rp) / 2;
        // [close]
    }

    static boolean shadowed(Scene s, Vec p, Vec i, float light) {
        // [open] does anything stand between p and the light: return false;
        for (Thing thing : s.things) if (distance(thing, p, i) < light) return true;
        return false;
        // [close]
    }

    /** Phong Effect. */
    static Vec localColour(Scene s, Material m, Vec p, Vec n, Vec v) {
        Vec c = m.ambient;
        // [open] add each light's diffuse and specular part to c: c = c.times(1);
        for (Light l : s.lights) {
            Vec w = l.point ? l.v.minus(p) : l.v;
            Vec i = w.unit();
            float cosine = i.dot(n);
            if (cosine <= 0) continue;
            float d = l.point ? w.length() : INFINITE;
            if (s.shadows && shadowed(s, p, i, d)) continue;
            float a = l.attenuation.equals("inverse") ? 1 / d : l.attenuation.equals("inverse_square") ? 1 / (d * d) : 1;
            float gloss = reflection(i, n).dot(v.negated());
            gloss = gloss > 0 ? (float) Math.pow(gloss, m.shininess) : 0;
            c = c.plus(l.color.times(a).times(m.diffuse.times(cosine).plus(m.specular.times(gloss))));
        }
        // [close]
        return c;
    }

    /** Modified FindRGB, Refraction with geo.tr vector. */
    static Vec findRGB(Scene s, Vec o, Vec v, int generation) {
        Thing nearest = null;
        float fmin = INFINITE;
        // [open] find the nearest thing and its distance fmin: fmin = INFINITE;
        for (Thing thing : s.things) {
            float f = distance(thing, o, v);
            if (f < fmin) {
                fmin = f;
                nearest = thing;
            }
        }
        // [close]
        if (nearest == null) return s.background;

        Material m = nearest.material;
        Vec p = o.plus(v.times(fmin));
        Vec n = normal(nearest, p);
        boolean leaving = n.dot(v) > 0;
        if (leaving) n = n.negated();
        Vec colour = localColour(s, m, p, n, v);
        if (generation == s.depth) return colour;

        // [open] add the mirrored and the refracted ray's colours: colour = colour.times(1);
        float share = s.fresnel ? fresnel(v, n, leaving, m.index) : 0;
        float keep = s.fresnel ? share : 1, through = s.fresnel ? 1 - share : 1;
        if (!m.reflect.black()) {
            Vec mirrored = findRGB(s, p, reflection(v.negated(), n), generation + 1);
            colour = colour.plus(m.reflect.times(keep).times(mirrored));
        }
        if (!m.transmit.black()) {
            Vec t = refraction(v, n, leaving, m.index);
            if (t != null) colour = colour.plus(m.transmit.times(through).times(findRGB(s, p, t, generation + 1)));
        }
        // [close]
        return colour;
    }

    // ------------------------------------------------------------ the picture
    static void writePFM(Path path, int width, int height, Vec[] pixels) throws IOException {
        byte[] header = ("PF\n" + width + " " + height + "\n-1.0\n").getBytes(StandardCharsets.US_ASCII);
        ByteBuffer file = ByteBuffer.allocate(header.length + 12 * width * height).order(ByteOrder.LITTLE_ENDIAN);
        file.put(header);
        for (int j = height - 1; j >= 0; j--) // PFM stores the bottom row first
            for (Vec c : Arrays.asList(pixels).subList(j * width, (j + 1) * width))
                file.putFloat(c.x).putFloat(c.y).putFloat(c.z);
        Files.write(path, file.array());
    }

    public static void main(String[] words) throws IOException {
        if (words.length != 2) {
            System.err.println("usage: java Tracer scene.txt image.pfm");
            System.exit(2);
        }
        Scene s = readScene(Path.of(words[0]));
        Vec[] pixels = new Vec[s.width * s.height];
        for (int j = 0; j < s.height; j++)
            for (int i = 0; i < s.width; i++) pixels[j * s.width + i] = findRGB(s, s.eye, ray(s, i, j), 0);
        writePFM(Path.of(words[1]), s.width, s.height, pixels);
    }
}
