// A ray tracer written from "Computer Graphics and Programming, Lecture 11, Ray Tracing".
//
//	./tracer scene.txt image.pfm
//
// Reads raycheck's text scenes, writes linear RGB as PFM. One file, standard library only.
package main

import (
	"bufio"
	"bytes"
	"encoding/binary"
	"fmt"
	"math"
	"os"
	"strconv"
	"strings"
)

type real = float32

const eps real = 2e-3 // nearer hits are taken for the surface the ray starts on

var infinite = real(math.Inf(1))

// ---------------------------------------------------------------- vectors and colours

type vec struct{ x, y, z real }

func add(a, b vec) vec         { return vec{a.x + b.x, a.y + b.y, a.z + b.z} }
func sub(a, b vec) vec         { return vec{a.x - b.x, a.y - b.y, a.z - b.z} }
func neg(a vec) vec            { return vec{-a.x, -a.y, -a.z} }
func scale(a vec, s real) vec  { return vec{a.x * s, a.y * s, a.z * s} }
func mul(a, b vec) vec         { return vec{a.x * b.x, a.y * b.y, a.z * b.z} }
func dot(a, b vec) real        { return a.x*b.x + a.y*b.y + a.z*b.z }
func root(x real) real         { return real(math.Sqrt(float64(x))) }
func power(x real, n int) real { return real(math.Pow(float64(x), float64(n))) }
func length(a vec) real        { return root(dot(a, a)) }
func unit(a vec) vec {
	if l := length(a); l > 0 {
		return scale(a, 1/l)
	}
	return a
}

var black = vec{}

// ---------------------------------------------------------------- the scene

type material struct {
	ambient, diffuse, specular vec
	shininess                  int
	reflect, transmit          vec
	index                      real
}

type object struct {
	sphere   bool
	v        vec  // centre of a sphere, normal of a plane
	s        real // radius of a sphere, offset of a plane
	material material
}

type light struct {
	point       bool
	v           vec // position of a point light, direction towards a directional one
	color       vec
	attenuation string
}

type scene struct {
	width, height, depth                int
	sx, sy                              real
	eye, forward, right, up, background vec
	shadows, fresnel                    bool
	objects                             []object
	lights                              []light
}

func fail(format string, values ...any) {
	fmt.Fprintf(os.Stderr, "tracer: "+format+"\n", values...)
	os.Exit(1)
}

func number(word string) real {
	x, err := strconv.ParseFloat(word, 32)
	if err != nil {
		fail("not a number: %s", word)
	}
	return real(x)
}

func vector(words []string) vec { return vec{number(words[0]), number(words[1]), number(words[2])} }

func whole(word string) int {
	n, err := strconv.Atoi(word)
	if err != nil {
		fail("not a whole number: %s", word)
	}
	return n
}

func readScene(path string) scene {
	file, err := os.Open(path)
	if err != nil {
		fail("%v", err)
	}
	defer file.Close()
	s := scene{}
	materials := map[string]material{}
	lines := bufio.NewScanner(file)
	for lines.Scan() {
		words := strings.Fields(lines.Text())
		if len(words) == 0 || strings.HasPrefix(words[0], "#") {
			continue
		}
		word, rest := words[0], words[1:]
		switch word {
		case "raycheck", "display":
		case "image":
			s.width, s.height, s.sx, s.sy = whole(rest[0]), whole(rest[1]), number(rest[2]), number(rest[3])
		case "eye":
			s.eye = vector(rest)
		case "forward":
			s.forward = vector(rest)
		case "right":
			s.right = vector(rest)
		case "up":
			s.up = vector(rest)
		case "background":
			s.background = vector(rest)
		case "depth":
			s.depth = whole(rest[0])
		case "shadows":
			s.shadows = rest[0] == "1"
		case "fresnel":
			s.fresnel = rest[0] == "1"
		case "material":
			n := rest[1:]
			materials[rest[0]] = material{vector(n), vector(n[3:]), vector(n[6:]), whole(n[9]), vector(n[10:]), vector(n[13:]), number(n[16])}
		case "sphere", "plane":
			m, known := materials[rest[4]]
			if !known {
				fail("unknown material %s", rest[4])
			}
			s.objects = append(s.objects, object{word == "sphere", vector(rest), number(rest[3]), m})
		case "point":
			s.lights = append(s.lights, light{true, vector(rest), vector(rest[3:]), rest[6]})
		case "directional":
			s.lights = append(s.lights, light{false, vector(rest), vector(rest[3:]), "none"})
		case "end":
			return s
		default:
			fail("unknown statement %s", word)
		}
	}
	fail("the scene ends early")
	return s
}

// ---------------------------------------------------------------- the lecture's formulas

// Ray Vector Calculation
func ray(s *scene, i, j int) vec {
	// [open] the direction through pixel (i, j), unit: return unit(s.forward)
	X := -1 + 2*(real(i)+s.sx)/real(s.width)
	Y := 1 - 2*(real(j)+s.sy)/real(s.height)
	return unit(add(s.forward, add(scale(s.right, X), scale(s.up, Y))))
	// [close]
}

// Sphere Intersection; a plane from normal.p = offset. Infinite: no hit
func distance(obj *object, o, v vec) real {
	if !obj.sphere {
		// [open] the distance to a plane: return infinite
		toward := dot(obj.v, v)
		if toward == 0 {
			return infinite
		}
		t := (obj.s - dot(obj.v, o)) / toward
		if t > eps {
			return t
		}
		return infinite
		// [close]
	}
	// [open] the smallest distance beyond eps to a sphere: return infinite
	b := sub(o, obj.v)
	bv := dot(b, v)
	D := bv*bv - (dot(b, b) - obj.s*obj.s)
	if D < 0 {
		return infinite
	}
	r := root(D)
	if -bv-r > eps {
		return -bv - r
	}
	if -bv+r > eps {
		return -bv + r
	}
	return infinite
	// [close]
}

func normal(obj *object, p vec) vec {
	// [open] the outward unit normal at p: return vec{0, 0, 1}
	if obj.sphere {
		return unit(sub(p, obj.v))
	}
	return unit(obj.v)
	// [close]
}

// Math of Reflection Vector
func reflection(i, n vec) vec {
	// [open] the mirror direction of i about n: return i
	return sub(scale(n, 2*dot(i, n)), i)
	// [close]
}

// Refraction Vector Calculation, entering and leaving; false under total internal reflection
func refraction(v, n vec, leaving bool, index real) (vec, bool) {
	// [open] Snell's law; n faces the ray: return vec{}, false
	p := sub(v, scale(n, dot(v, n)))
	s := scale(p, 1/index)
	if leaving {
		s = scale(p, index)
	}
	sin2 := dot(s, s)
	if sin2 >= 1 {
		return vec{}, false
	}
	return unit(sub(s, scale(n, root(1-sin2)))), true
	// [close]
}

// Reflected share at a dielectric (only for scenes that ask for it)
func fresnel(v, n vec, leaving bool, index real) real {
	// [open] the exact dielectric formula: return 1
	n1, n2 := real(1), index
	if leaving {
		n1, n2 = index, 1
	}
	c1 := -dot(v, n)
	sin2 := (n1 / n2) * (n1 / n2) * (1 - c1*c1)
	if sin2 >= 1 {
		return 1
	}
	c2 := root(1 - sin2)
	rs := (n1*c1 - n2*c2) / (n1*c1 + n2*c2)
	rp := (n2*c1 - n1*c2) / (n2*c1 + n1*c2)
	return (rs*rs + rp*rp) / 2
	// [close]
}

func shadowed(s *scene, p, i vec, far real) bool {
	// [open] does anything stand between p and the light: return false
	for k := range s.objects {
		if distance(&s.objects[k], p, i) < far {
			return true
		}
	}
	return false
	// [close]
}

// Phong Effect
func localColour(s *scene, m *material, p, n, v vec) vec {
	c := m.ambient
	// [open] add each light's diffuse and specular part to c: return c
	for _, l := range s.lights {
		w, d := l.v, infinite
		if l.point {
			w = sub(l.v, p)
			d = length(w)
		}
		i := unit(w)
		cosine := dot(i, n)
		if cosine <= 0 || (s.shadows && shadowed(s, p, i, d)) {
			continue
		}
		a := real(1)
		if l.attenuation == "inverse" {
			a = 1 / d
		} else if l.attenuation == "inverse_square" {
			a = 1 / (d * d)
		}
		gloss := dot(reflection(i, n), neg(v))
		if gloss > 0 {
			gloss = power(gloss, m.shininess)
		} else {
			gloss = 0
		}
		c = add(c, mul(scale(l.color, a), add(scale(m.diffuse, cosine), scale(m.specular, gloss))))
	}
	// [close]
	return c
}

// Modified FindRGB, Refraction with geo.tr vector
func findRGB(s *scene, o, v vec, generation int) vec {
	var nearest *object
	fmin := infinite
	// [open] find the nearest object and its distance fmin: nearest = nil
	for k := range s.objects {
		if f := distance(&s.objects[k], o, v); f < fmin {
			nearest, fmin = &s.objects[k], f
		}
	}
	// [close]
	if nearest == nil {
		return s.background
	}

	m := &nearest.material
	p := add(o, scale(v, fmin))
	n := normal(nearest, p)
	leaving := dot(n, v) > 0
	if leaving {
		n = neg(n)
	}
	colour := localColour(s, m, p, n, v)
	if generation == s.depth {
		return colour
	}

	// [open] add the mirrored and the refracted ray's colours: return colour
	keep, through := real(1), real(1)
	if s.fresnel {
		keep = fresnel(v, n, leaving, m.index)
		through = 1 - keep
	}
	if m.reflect != black {
		mirrored := findRGB(s, p, reflection(neg(v), n), generation+1)
		colour = add(colour, mul(scale(m.reflect, keep), mirrored))
	}
	if m.transmit != black {
		if t, passes := refraction(v, n, leaving, m.index); passes {
			colour = add(colour, mul(scale(m.transmit, through), findRGB(s, p, t, generation+1)))
		}
	}
	// [close]
	return colour
}

// ---------------------------------------------------------------- the picture

func writePFM(path string, width, height int, pixels []vec) {
	var file bytes.Buffer
	fmt.Fprintf(&file, "PF\n%d %d\n-1.0\n", width, height)
	for j := height - 1; j >= 0; j-- { // PFM stores the bottom row first
		for _, c := range pixels[j*width : (j+1)*width] {
			binary.Write(&file, binary.LittleEndian, []float32{float32(c.x), float32(c.y), float32(c.z)})
		}
	}
	if err := os.WriteFile(path, file.Bytes(), 0o644); err != nil {
		fail("%v", err)
	}
}

func main() {
	if len(os.Args) != 3 {
		fmt.Fprintln(os.Stderr, "usage: tracer scene.txt image.pfm")
		os.Exit(2)
	}
	s := readScene(os.Args[1])
	pixels := make([]vec, 0, s.width*s.height)
	for j := 0; j < s.height; j++ {
		for i := 0; i < s.width; i++ {
			pixels = append(pixels, findRGB(&s, s.eye, ray(&s, i, j), 0))
		}
	}
	writePFM(os.Args[2], s.width, s.height, pixels)
}
