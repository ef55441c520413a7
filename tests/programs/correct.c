/* A ray tracer as a first course teaches it: every formula of the picture, in doubles. */

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* With the name of a mistake as its argument, it makes that: the tests need some. */
#define MISTAKES(EACH) \
    EACH(NONE) EACH(UPSIDE_DOWN) EACH(TRANSPOSED) EACH(HALF_PIXEL_OFF) EACH(GAMMA) EACH(BGR) \
    EACH(BYTES) EACH(DEGREES) EACH(LIGHT_SIGN) EACH(LIGHT_DIRECTION) EACH(SHADOW_DIRECTION) \
    EACH(SHADOW_RAY) EACH(SHADOW_BEHIND) EACH(SHADOW_LINE) EACH(SHADOW_OWN) EACH(FAR_ROOT) \
    EACH(FAR_ROOTS) EACH(SHADOW_ACNE)
#define NUMBER(name) name,
#define NAME(name) #name,
enum { MISTAKES(NUMBER) MISTAKE_COUNT };
static const char *const names[] = {MISTAKES(NAME)};
static int mistake = NONE;
#define MAKES(one, other) (mistake == one || mistake == other)

typedef struct { double x, y, z; } Vector;
typedef struct { Vector center; double radius; Vector color; } Sphere;
typedef struct { Vector vertices[4], color; } Tetrahedron;
typedef struct { Vector origin, direction; } Ray;
typedef struct { int solid; double t; Vector normal, color; } Hit;

enum { MOST = 4096, NOBODY = -1 };

/* The scene; without a surface, `half_width` is negative. */
static double height, half_width, reflectance, exponent;
static Vector background, surface_color, light_direction, intensity, ambient_intensity;
static Vector ambient, diffuse, specular;
static Sphere spheres[MOST];
static Tetrahedron tetrahedra[MOST];
static int sphere_count, tetrahedron_count;

static Vector add(Vector a, Vector b) { return (Vector){a.x + b.x, a.y + b.y, a.z + b.z}; }
static Vector subtract(Vector a, Vector b) { return (Vector){a.x - b.x, a.y - b.y, a.z - b.z}; }
static Vector scale(double s, Vector a) { return (Vector){s * a.x, s * a.y, s * a.z}; }
static Vector times(Vector a, Vector b) { return (Vector){a.x * b.x, a.y * b.y, a.z * b.z}; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vector cross(Vector a, Vector b) {
    return (Vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static Vector unit(Vector a) { return scale(1 / sqrt(dot(a, a)), a); }
static Vector at(Ray ray, double t) { return add(ray.origin, scale(t, ray.direction)); }

/* Where the line of a ray enters and leaves a sphere, and the normal where it enters. */
static bool meet_sphere(const Sphere *sphere, Ray ray,
                        double *enter, double *leave, Vector *normal) {
    Vector from_center = subtract(ray.origin, sphere->center);
    double a = dot(ray.direction, ray.direction);
    double b = dot(ray.direction, from_center);
    double c = dot(from_center, from_center) - sphere->radius * sphere->radius;
    double discriminant = b * b - a * c;
    if (discriminant < 0)
        return false;
    double root = MAKES(FAR_ROOT, FAR_ROOTS) ? -sqrt(discriminant) : sqrt(discriminant);
    *enter = (-b - root) / a;
    *leave = (-b + root) / a;
    *normal = unit(subtract(at(ray, *enter), sphere->center));
    return true;
}

/* The same for a tetrahedron: a line has entered it when it is behind all of its faces. */
static bool meet_tetrahedron(const Tetrahedron *solid, Ray ray,
                             double *enter, double *leave, Vector *normal) {
    *enter = -INFINITY;
    *leave = INFINITY;
    for (int face = 0; face < 4; face++) {
        Vector a = solid->vertices[(face + 1) % 4], b = solid->vertices[(face + 2) % 4];
        Vector c = solid->vertices[(face + 3) % 4], opposite = solid->vertices[face];
        Vector outward = unit(cross(subtract(b, a), subtract(c, a)));
        if (dot(outward, subtract(opposite, a)) > 0)
            outward = scale(-1, outward);
        double outside = dot(outward, subtract(ray.origin, a));
        double speed = dot(outward, ray.direction);
        if (speed == 0 && outside > 0)
            return false;
        if (speed < 0 && -outside / speed > *enter) {
            *enter = -outside / speed;
            *normal = outward;
        }
        if (speed > 0 && -outside / speed < *leave)
            *leave = -outside / speed;
    }
    return *enter <= *leave;
}

/* The same for any solid: the spheres come first. */
static bool meet(int solid, Ray ray, double *enter, double *leave, Vector *normal) {
    if (solid < sphere_count)
        return meet_sphere(&spheres[solid], ray, enter, leave, normal);
    if (mistake == FAR_ROOTS) {
        Ray back = {ray.origin, scale(-1, ray.direction)};
        bool met = meet_tetrahedron(&tetrahedra[solid - sphere_count], back, enter, leave, normal);
        *enter = -*enter;
        *leave = -*leave;
        return met;
    }
    return meet_tetrahedron(&tetrahedra[solid - sphere_count], ray, enter, leave, normal);
}

/* The first of the solids from `first` to `last` that a ray meets: on its whole line, or ahead. */
static Hit first_hit(Ray ray, int first, int last, bool ahead) {
    Hit hit = {NOBODY, INFINITY, {0, 0, 0}, {0, 0, 0}};
    for (int solid = first; solid <= last; solid++) {
        double enter, leave;
        Vector normal;
        if (meet(solid, ray, &enter, &leave, &normal) && (!ahead || leave > 0) && enter < hit.t) {
            Vector color = solid < sphere_count ? spheres[solid].color
                                                : tetrahedra[solid - sphere_count].color;
            hit = (Hit){solid, enter, normal, color};
        }
    }
    return hit;
}

/* Where a ray meets the surface. */
static bool meet_surface(Ray ray, double *t) {
    *t = (height - ray.origin.y) / ray.direction.y;
    Vector point = at(ray, *t);
    return fabs(point.x) <= half_width && fabs(point.z) <= half_width;
}

static Vector to_light(void) {
    return unit(scale(mistake == LIGHT_DIRECTION ? 1 : -1, light_direction));
}

/* Whether a solid but this one stands between a point and the light. */
static bool is_hidden(Vector point, int but) {
    Ray ray = {point, MAKES(SHADOW_DIRECTION, SHADOW_RAY) ? light_direction : to_light()};
    for (int solid = 0; solid < sphere_count + tetrahedron_count; solid++) {
        double enter, leave;
        Vector normal;
        if (solid == but && !MAKES(SHADOW_ACNE, SHADOW_OWN))
            continue;
        bool takes_all = MAKES(SHADOW_BEHIND, SHADOW_LINE) || mistake == SHADOW_OWN;
        if (meet(solid, ray, &enter, &leave, &normal) && (leave > 0 || takes_all))
            return true;
    }
    return false;
}

/* Equation 4-1 where a ray hits a solid. */
static Vector shade(Ray ray, Hit hit, bool shadows) {
    Vector point = at(ray, hit.t), l = to_light(), v = unit(scale(-1, ray.direction));
    if (mistake == LIGHT_SIGN)
        l = scale(-1, l);
    Vector h = unit(add(v, l));
    double normal_light = dot(hit.normal, l), t;
    double highlight = pow(fmax(0, dot(hit.normal, h)), exponent);
    Vector light = times(ambient, ambient_intensity);
    Ray shadow = {point, mistake == SHADOW_RAY ? light_direction : l};
    bool under_surface = meet_surface(shadow, &t) && (t > 0 || mistake == SHADOW_LINE);
    bool in_shadow = shadows
        && (normal_light <= 0 || under_surface || is_hidden(point, hit.solid));
    if (!in_shadow) {
        light = add(light, scale(fmax(0, normal_light), times(diffuse, intensity)));
        light = add(light, scale(highlight, times(specular, intensity)));
    }
    return times(hit.color, light);
}

/* What the surface shows where a ray meets it. */
static Vector surface_at(Ray ray, double t, int stage) {
    Ray mirrored = {at(ray, t), {ray.direction.x, -ray.direction.y, ray.direction.z}};
    mirrored.origin.y = height;
    if (is_hidden(mirrored.origin, NOBODY))
        return times(ambient, ambient_intensity);
    if (stage >= 6) {
        Hit hit = first_hit(mirrored, 0, sphere_count + tetrahedron_count - 1, true);
        if (hit.solid != NOBODY)
            return scale(reflectance, shade(mirrored, hit, true));
    }
    return surface_color;
}

static Vector pixel(double x, double y, int stage, double alpha, int size) {
    if (stage == 1) {
        if (2 * x <= size)
            return 2 * y <= size ? (Vector){0.3, 0.3, 0} : (Vector){0, 0.3, 0.3};
        return 2 * y <= size ? (Vector){0.3, 0, 0.3} : (Vector){0, 0, 0};
    }
    double u = (x - size / 2.0) / (size / 2.0), v = (y - size / 2.0) / (size / 2.0);
    Ray ray = {
        {sin(alpha) + u * cos(alpha), v, cos(alpha) - u * sin(alpha)},
        {-sin(alpha), -0.3, -cos(alpha)},
    };
    int first = stage == 3 ? sphere_count : 0;
    int last = stage == 2 ? sphere_count - 1 : sphere_count + tetrahedron_count - 1;
    Hit hit = first_hit(ray, first, last, false);
    double t;
    if (stage >= 5 && meet_surface(ray, &t) && t < hit.t)
        return surface_at(ray, t, stage);
    if (hit.solid == NOBODY)
        return background;
    return stage < 4 ? hit.color : shade(ray, hit, stage >= 5);
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
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        perror(path);
        exit(1);
    }
    half_width = -1;
    sphere_count = tetrahedron_count = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        double n[12] = {0};
        /* [table] or [[table]] */
        if (sscanf(line, "[%31[a-z]", table) == 1 || sscanf(line, "[[%31[a-z]", table) == 1) {
            sphere_count += strcmp(table, "sphere") == 0;
            tetrahedron_count += strcmp(table, "tetrahedron") == 0;
            continue;
        }
        if (sscanf(line, " %31[a-z_] =", key) != 1)
            continue;
        read_numbers(strchr(line, '=') + 1, n);
        Vector three = {n[0], n[1], n[2]};
        Sphere *sphere = &spheres[sphere_count > 0 ? sphere_count - 1 : 0];
        Tetrahedron *tetrahedron = &tetrahedra[tetrahedron_count > 0 ? tetrahedron_count - 1 : 0];
        if (strcmp(key, "background") == 0) background = three;
        if (strcmp(key, "height") == 0) height = n[0];
        if (strcmp(key, "half_width") == 0) half_width = n[0];
        if (strcmp(key, "reflectance") == 0) reflectance = n[0];
        if (strcmp(key, "direction") == 0) light_direction = three;
        if (strcmp(key, "intensity") == 0) intensity = three;
        if (strcmp(key, "ambient_intensity") == 0) ambient_intensity = three;
        if (strcmp(key, "ambient") == 0) ambient = three;
        if (strcmp(key, "diffuse") == 0) diffuse = three;
        if (strcmp(key, "specular") == 0) specular = three;
        if (strcmp(key, "exponent") == 0) exponent = n[0];
        if (strcmp(key, "center") == 0) sphere->center = three;
        if (strcmp(key, "radius") == 0) sphere->radius = n[0];
        if (strcmp(key, "vertices") == 0)
            for (int i = 0; i < 4; i++)
                tetrahedron->vertices[i] = (Vector){n[3 * i], n[3 * i + 1], n[3 * i + 2]};
        if (strcmp(key, "color") == 0) {
            if (strcmp(table, "surface") == 0) surface_color = three;
            if (strcmp(table, "sphere") == 0) sphere->color = three;
            if (strcmp(table, "tetrahedron") == 0) tetrahedron->color = three;
        }
    }
    fclose(file);
}

int main(int count, char **words) {
    if (count > 1)
        while (strcmp(words[1], names[mistake]) != 0)
            if (++mistake == MISTAKE_COUNT)
                return 2;
    char request[4096], path[4096];
    int stage, size;
    double alpha;
    while (fgets(request, sizeof request, stdin) != NULL) {
        if (sscanf(request, "{\"scene\": \"%[^\"]\", \"stage\": %d, \"alpha\": %lf, \"size\": %d}",
                   path, &stage, &alpha, &size) != 4)
            return 1;
        read_scene(path);
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                Vector color = mistake == TRANSPOSED ? pixel(y, x, stage, alpha, size)
                    : mistake == UPSIDE_DOWN ? pixel(x, size - 1 - y, stage, alpha, size)
                    : mistake == HALF_PIXEL_OFF ? pixel(x + 0.5, y + 0.5, stage, alpha, size)
                    : pixel(x, y, stage, mistake == DEGREES ? alpha * acos(-1) / 180 : alpha, size);
                float rgb[3] = {color.x, color.y, color.z};
                if (mistake == BGR)
                    rgb[0] = color.z, rgb[2] = color.x;
                for (int i = 0; i < 3 && mistake == BYTES; i++)
                    rgb[i] = 255 * rgb[i];
                for (int i = 0; i < 3 && mistake == GAMMA; i++)
                    rgb[i] = powf(rgb[i], 1 / 2.2f);
                fwrite(rgb, sizeof rgb, 1, stdout);
            }
        fflush(stdout);
    }
    return 0;
}
