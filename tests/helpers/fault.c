// Faults of a system and of its OpenGL drivers, chosen by the environment variable FAULT. To be preloaded.
//
// The program finds its drivers by dlsym, so what that returns is exchanged here, and what it returns for a driver's own function of that kind.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static int is(const char *fault) {
    const char *chosen = getenv("FAULT");
    return chosen && !strcmp(chosen, fault);
}

// A file system on which every file has a name.
int open64(const char *path, int flags, ...) {
    static int (*real)(const char *, int, ...);
    if (!real) real = (int (*)(const char *, int, ...))dlvsym(RTLD_NEXT, "open64", "GLIBC_2.2.5");
    if (!real) real = (int (*)(const char *, int, ...))dlvsym(RTLD_NEXT, "open64", "GLIBC_2.17");
    if ((flags & O_TMPFILE) == O_TMPFILE && is("names")) {
        errno = EOPNOTSUPP;
        return -1;
    }
    va_list rest;
    va_start(rest, flags);
    int mode = va_arg(rest, int);
    va_end(rest);
    return real(path, flags, mode);
}

// A system without a clock, on which Rust's standard library panics.
int clock_gettime(clockid_t clock, struct timespec *time) {
    static int (*real)(clockid_t, struct timespec *);
    if (!real) real = (int (*)(clockid_t, struct timespec *))dlvsym(RTLD_NEXT, "clock_gettime", "GLIBC_2.17");
    if (is("has no clock")) {
        errno = EINVAL;
        return -1;
    }
    return real(clock, time);
}

typedef void (*Function)(void);
typedef Function (*Lookup)(const char *);
typedef const unsigned char *(*GetString)(unsigned);
typedef void (*ReadPixels)(int, int, int, int, unsigned, unsigned, void *);

static GetString get_string;
static ReadPixels read_pixels;

// GL_VERSION.
static const unsigned char *without_version(unsigned name) { return name == 0x1F02 ? NULL : get_string(name); }

static void draw_nothing(unsigned mode, int first, int count) { (void)mode, (void)first, (void)count; }

static void wrong_pixels(int x, int y, int width, int height, unsigned format, unsigned type, void *pixels) {
    if (is("waits")) for (;;) pause();
    if (is("does not read back")) return;
    read_pixels(x, y, width, height, format, type, pixels);
    // GL_RGB, GL_FLOAT.
    if (format == 0x1907 && type == 0x1406) {
        float *samples = pixels;
        for (long i = 0; i < 3L * width * height; i++) {
            unsigned bits;
            memcpy(&bits, &samples[i], 4);
            if (is("clears low bits")) bits &= ~0xFFFu;
            memcpy(&samples[i], &bits, 4);
            if (is("stores 8 bits")) samples[i] = (float)(int)(samples[i] * 255.0f + 0.5f) / 255.0f;
        }
    }
    // GL_RGBA, GL_UNSIGNED_BYTE, as of a window: one pixel is wrong.
    if (format == 0x1908 && type == 0x1401 && is("shows a wrong pixel")) ((unsigned char *)pixels)[4 * (7L * width + 5)] ^= 1;
}

static Function exchanged(const char *name, Function found) {
    if (!strcmp(name, "glGetString") && is("has no version")) {
        get_string = (GetString)found;
        return (Function)without_version;
    }
    if (!strcmp(name, "glDrawArrays") && is("draws nothing")) return (Function)draw_nothing;
    if (!strcmp(name, "glReadPixels")) {
        read_pixels = (ReadPixels)found;
        return (Function)wrong_pixels;
    }
    return found;
}

static Lookup egl, osmesa, glx;
static Function in_egl(const char *name) { return exchanged(name, egl(name)); }
static Function in_osmesa(const char *name) { return exchanged(name, osmesa(name)); }
static Function in_glx(const char *name) { return exchanged(name, glx(name)); }

void *dlsym(void *library, const char *name) {
    static void *(*real)(void *, const char *);
    if (!real) real = (void *(*)(void *, const char *))dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    if (!real) real = (void *(*)(void *, const char *))dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.17");
    void *found = real(library, name);
    if (!found) return found;
    if (!strcmp(name, "eglGetProcAddress")) {
        if (is("has no eglGetProcAddress")) return real(library, "a function that is not there");
        egl = (Lookup)found;
        return (void *)in_egl;
    }
    if (!strcmp(name, "OSMesaGetProcAddress")) {
        osmesa = (Lookup)found;
        return (void *)in_osmesa;
    }
    if (!strcmp(name, "glXGetProcAddress") || !strcmp(name, "glXGetProcAddressARB")) {
        glx = (Lookup)found;
        return (void *)in_glx;
    }
    return found;
}
