/* The homework as the document prints it, Code 2-1 to 6-1, slips included. */

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct { double x, y, z; } Vector;
typedef struct { Vector center; double R; Vector color; } Sphere;
typedef struct { Vector ver1, ver2, ver3, normal; } Triangle;
typedef struct { Vector vertices[4]; Triangle t[4]; Vector color; } Tetrahedron;
typedef struct { double height, half_width, reflectance; Vector color; } Surface;
typedef struct { Vector ka, kd, ks, Ia, Ib; double exponent; } Light;

static Vector Background, LigDir, LookAt;
static Sphere S[2];
static Tetrahedron T;
static Surface Sur;
static Light I;
static bool IntSphere, IntTriangle, IntTetrahedron, IntSurface;
static int IntTriangle_No;

static Vector add(Vector a, Vector b) { return (Vector){a.x + b.x, a.y + b.y, a.z + b.z}; }
static Vector sub(Vector a, Vector b) { return (Vector){a.x - b.x, a.y - b.y, a.z - b.z}; }
static Vector mul(double s, Vector a) { return (Vector){s * a.x, s * a.y, s * a.z}; }
static Vector times(Vector a, Vector b) { return (Vector){a.x * b.x, a.y * b.y, a.z * b.z}; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vector cross(Vector a, Vector b) {
    return (Vector){a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
static double length(Vector a) { return sqrt(dot(a, a)); }
static double distance(Vector a, Vector b) { return length(sub(a, b)); }
static Vector GetUnit(Vector a) {
    double l = length(a);
    return (Vector){a.x / l, a.y / l, a.z / l};
}

/* Code 3-1. */
static Vector GetInterPoint_Sphere(Vector pixel, Vector dir, Sphere s) {
    double t1, t2, t;
    double temp1 = dot(dir, sub(pixel, s.center));
    temp1 = temp1 * temp1;
    Vector away = sub(pixel, s.center);
    double temp2 = dot(dir, dir) * (dot(away, away) - s.R * s.R);
    IntSphere = true;
    if (temp1 - temp2 < 0) {
        IntSphere = false;
        return pixel;
    }
    temp1 = sqrt(temp1 - temp2);
    temp2 = -dot(dir, away);
    t1 = (temp2 + temp1) / dot(dir, dir);
    t2 = (temp2 - temp1) / dot(dir, dir);
    t = fabs(t1) > fabs(t2) ? t2 : t1;
    return add(pixel, mul(t, dir));
}

/* Code 3-2, one face. */
static Vector GetInterPoint_Triangle(Vector pixel, Vector dir, Triangle t) {
    Vector result = {0, 0, 0};
    double t1 = dot(sub(t.ver1, pixel), t.normal) / dot(dir, t.normal);
    Vector ab = sub(t.ver2, t.ver1), bc = sub(t.ver3, t.ver2), ca = sub(t.ver1, t.ver3);
    Vector temp = add(pixel, mul(t1, dir));
    if (dot(cross(ab, sub(temp, t.ver1)), t.normal) > 0
        && dot(cross(bc, sub(temp, t.ver2)), t.normal) > 0
        && dot(cross(ca, sub(temp, t.ver3)), t.normal) > 0) {
        IntTriangle = true;
        result = temp;
    }
    return result;
}

/* Code 3-2. */
static Vector GetInterPoint_Tetrahedron(Vector pixel, Vector dir) {
    Vector result = {0, 0, 0};
    double distance_nearest = 0;
    IntTetrahedron = IntTriangle = false;
    for (int no = 1; no <= 4; no++) {
        Vector result_temp = GetInterPoint_Triangle(pixel, dir, T.t[no - 1]);
        if (IntTriangle) {
            double distance_temp = distance(pixel, result_temp);
            if (no == 1 || distance_temp < distance_nearest) {
                result = result_temp;
                distance_nearest = distance_temp;
                IntTriangle_No = no;
                IntTetrahedron = true;
            }
        }
    }
    return result;
}

static Vector GetInterPoint_Surface(Vector pixel, Vector dir) {
    double t = (Sur.height - pixel.y) / dir.y;
    Vector result = {pixel.x + t * dir.x, Sur.height, pixel.z + t * dir.z};
    IntSurface = fabs(result.x) <= Sur.half_width && fabs(result.z) <= Sur.half_width;
    return result;
}

static Vector GetNormal_Sphere(Vector point, Sphere s) { return GetUnit(sub(point, s.center)); }
static Vector GetNormal_Tetrahedron(void) { return T.t[IntTriangle_No - 1].normal; }
static Vector GetProjection(Vector d, Vector n) { return sub(d, mul(2 * dot(d, n), n)); }

/* Code 4-1. */
static Vector GetPixelColor(Vector ligdir, Vector viewdir, Vector normal) {
    Vector h = GetUnit(add(viewdir, ligdir));
    double mul_nl = dot(ligdir, normal), mul_nh = dot(normal, h);
    double max_nl = mul_nl > 0 ? mul_nl : 0, max_nh = mul_nh > 0 ? mul_nh : 0;
    Vector diffuse = mul(max_nl, times(I.kd, I.Ib));
    Vector specular = mul(pow(max_nh, I.exponent), times(I.ks, I.Ib));
    return add(add(times(I.ka, I.Ia), diffuse), specular);
}

static Vector ColorOfSphere(Vector point, Sphere s) {
    return times(GetPixelColor(LigDir, LookAt, GetNormal_Sphere(point, s)), s.color);
}

static Vector ColorOfTetrahedron(void) {
    return times(GetPixelColor(LigDir, LookAt, GetNormal_Tetrahedron()), T.color);
}

/* Code 5-1: each object that is met overwrites what was drawn before. */
static Vector ColorOfSurface(Vector interpoint0, int stage) {
    Vector color = Sur.color, point;
    if (stage >= 6) {
        Vector ProDir = mul(-1, GetProjection(LookAt, (Vector){0, 1, 0}));
        for (int i = 0; i < 2; i++) {
            point = GetInterPoint_Sphere(interpoint0, ProDir, S[i]);
            if (IntSphere)
                color = mul(Sur.reflectance, ColorOfSphere(point, S[i]));
        }
        GetInterPoint_Tetrahedron(interpoint0, ProDir);
        if (IntTetrahedron)
            color = mul(Sur.reflectance, ColorOfTetrahedron());
    }
    Vector ligtemp = mul(-1, LigDir);
    GetInterPoint_Sphere(interpoint0, ligtemp, S[0]);
    bool shadow = IntSphere;
    GetInterPoint_Sphere(interpoint0, LigDir, S[1]);
    shadow = shadow || IntSphere;
    GetInterPoint_Tetrahedron(interpoint0, ligtemp);
    shadow = shadow || IntTetrahedron;
    return shadow ? times(I.ka, I.Ia) : color;
}

/* Code 2-1. */
static Vector ColorOfQuadrant(int x, int y, int size) {
    if (2 * x <= size && 2 * y <= size) return (Vector){0.3, 0.3, 0};
    if (2 * x <= size && 2 * y >= size) return (Vector){0, 0.3, 0.3};
    if (2 * x >= size && 2 * y <= size) return (Vector){0.3, 0, 0.3};
    return (Vector){0, 0, 0};
}

/* The nearest object, and its colour. */
static Vector ColorOfPixel(Vector pixel, int stage) {
    Vector color = Background, point;
    double nearest = INFINITY;
    if (stage != 3)
        for (int i = 0; i < 2; i++) {
            point = GetInterPoint_Sphere(pixel, LookAt, S[i]);
            if (IntSphere && distance(pixel, point) < nearest) {
                nearest = distance(pixel, point);
                color = stage == 2 ? S[i].color : ColorOfSphere(point, S[i]);
            }
        }
    if (stage != 2) {
        point = GetInterPoint_Tetrahedron(pixel, LookAt);
        if (IntTetrahedron && distance(pixel, point) < nearest) {
            nearest = distance(pixel, point);
            color = stage == 3 ? T.color : ColorOfTetrahedron();
        }
    }
    if (stage >= 5) {
        point = GetInterPoint_Surface(pixel, LookAt);
        if (IntSurface && distance(pixel, point) < nearest)
            color = ColorOfSurface(point, stage);
    }
    return color;
}

static void draw(int stage, double alpha, int size) {
    double half = size / 2.0;
    LookAt = GetUnit((Vector){sin(alpha), 0.3, cos(alpha)});
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            Vector pixel = {
                (x - half) / half * cos(alpha) + sin(alpha),
                (y - half) / half,
                cos(alpha) - (x - half) / half * sin(alpha),
            };
            Vector color = stage == 1 ? ColorOfQuadrant(x, y, size) : ColorOfPixel(pixel, stage);
            float rgb[3] = {color.x, color.y, color.z};
            fwrite(rgb, sizeof rgb, 1, stdout);
        }
    fflush(stdout);
}

/* Triangle k + 1 is the face opposite vertex k, counter-clockwise as seen from outside. */
static void make_triangles(void) {
    static const int faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    Vector *v = T.vertices;
    bool right_handed = dot(cross(sub(v[1], v[0]), sub(v[2], v[0])), sub(v[3], v[0])) > 0;
    for (int k = 0; k < 4; k++) {
        Vector a = v[faces[k][0]];
        Vector b = v[faces[k][right_handed ? 1 : 2]], c = v[faces[k][right_handed ? 2 : 1]];
        T.t[k] = (Triangle){a, b, c, GetUnit(cross(sub(b, a), sub(c, a)))};
    }
}

/* The numbers of a line, up to 12. */
static void read_numbers(const char *text, double *numbers) {
    for (int i = 0; i < 12 && *text != '\0' && *text != '#'; ) {
        char *end;
        numbers[i] = strtod(text, &end);
        i += end != text;
        text = end != text ? end : text + 1;
    }
}

static void read_scene(const char *path) {
    char line[1024], table[32] = "", key[32];
    int spheres = 0;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        perror(path);
        exit(1);
    }
    while (fgets(line, sizeof line, file) != NULL) {
        double n[12] = {0};
        /* [table] or [[table]] */
        if (sscanf(line, "[%31[a-z]", table) == 1 || sscanf(line, "[[%31[a-z]", table) == 1) {
            spheres += strcmp(table, "sphere") == 0;
            continue;
        }
        if (sscanf(line, " %31[a-z_] =", key) != 1)
            continue;
        read_numbers(strchr(line, '=') + 1, n);
        Vector three = {n[0], n[1], n[2]};
        Sphere *sphere = &S[spheres == 2];
        if (strcmp(key, "background") == 0) Background = three;
        if (strcmp(key, "height") == 0) Sur.height = n[0];
        if (strcmp(key, "half_width") == 0) Sur.half_width = n[0];
        if (strcmp(key, "reflectance") == 0) Sur.reflectance = n[0];
        if (strcmp(key, "direction") == 0) LigDir = GetUnit(three);
        if (strcmp(key, "intensity") == 0) I.Ib = three;
        if (strcmp(key, "ambient_intensity") == 0) I.Ia = three;
        if (strcmp(key, "ambient") == 0) I.ka = three;
        if (strcmp(key, "diffuse") == 0) I.kd = three;
        if (strcmp(key, "specular") == 0) I.ks = three;
        if (strcmp(key, "exponent") == 0) I.exponent = n[0];
        if (strcmp(key, "center") == 0) sphere->center = three;
        if (strcmp(key, "radius") == 0) sphere->R = n[0];
        if (strcmp(key, "vertices") == 0)
            for (int i = 0; i < 4; i++)
                T.vertices[i] = (Vector){n[3 * i], n[3 * i + 1], n[3 * i + 2]};
        if (strcmp(key, "color") == 0) {
            if (strcmp(table, "surface") == 0) Sur.color = three;
            if (strcmp(table, "sphere") == 0) sphere->color = three;
            if (strcmp(table, "tetrahedron") == 0) T.color = three;
        }
    }
    fclose(file);
    make_triangles();
}

int main(void) {
    char request[4096], path[4096];
    int stage, size;
    double alpha;
    while (fgets(request, sizeof request, stdin) != NULL) {
        if (sscanf(request, "{\"scene\": \"%[^\"]\", \"stage\": %d, \"alpha\": %lf, \"size\": %d}",
                   path, &stage, &alpha, &size) != 4)
            return 1;
        read_scene(path);
        draw(stage, alpha, size);
    }
    return 0;
}
