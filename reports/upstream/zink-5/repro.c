/*
 * zink: a stencil clear with a partial write mask clears the masked bits to 0
 *
 * Build and run:
 *   cc repro.c -ldl -o repro
 *   VK_DRIVER_FILES=/usr/share/vulkan/icd.d/lvp_icd.json MESA_LOADER_DRIVER_OVERRIDE=zink LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=zink ./repro
 *
 * The first argument, if there is one, is the EGL library to load. Exit status: 1 if the bug is
 * there, 0 if not, 77 if the driver lacks something, 2 if a call fails.
 * Needs the headers of the C library and none of the API.
 */

#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BUG = 1, FAILED = 2, LACKS = 77 };

typedef unsigned int GLenum;
typedef unsigned int GLuint;
typedef int GLint;
typedef unsigned char GLboolean;
typedef float GLfloat;
typedef double GLdouble;
typedef intptr_t GLsizeiptr;

#define GL_ARRAY_BUFFER 0x8892
#define GL_CLAMP_READ_COLOR 0x891C
#define GL_CLAMP_TO_EDGE 0x812F
#define GL_DEPTH24_STENCIL8 0x88F0
#define GL_DEPTH_STENCIL 0x84F9
#define GL_DEPTH_STENCIL_ATTACHMENT 0x821A
#define GL_DITHER 0x0BD0
#define GL_ELEMENT_ARRAY_BUFFER 0x8893
#define GL_FRAMEBUFFER 0x8D40
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#define GL_NEAREST 0x2600
#define GL_NONE 0x0000
#define GL_PACK_ALIGNMENT 0x0D05
#define GL_PACK_ROW_LENGTH 0x0D02
#define GL_TEXTURE0 0x84C0
#define GL_TEXTURE_2D 0x0DE1
#define GL_TEXTURE_BASE_LEVEL 0x813C
#define GL_TEXTURE_MAG_FILTER 0x2800
#define GL_TEXTURE_MAX_LEVEL 0x813D
#define GL_TEXTURE_MIN_FILTER 0x2801
#define GL_TEXTURE_WRAP_S 0x2802
#define GL_TEXTURE_WRAP_T 0x2803
#define GL_UNPACK_ALIGNMENT 0x0CF5
#define GL_UNSIGNED_INT_24_8 0x84FA
#define GL_UPPER_LEFT 0x8CA2
#define GL_ZERO_TO_ONE 0x935F

static void (*glActiveTexture)(GLenum);
static void (*glBindBuffer)(GLenum, GLuint);
static void (*glBindFramebuffer)(GLenum, GLuint);
static void (*glBindTexture)(GLenum, GLuint);
static void (*glBindVertexArray)(GLuint);
static GLenum (*glCheckFramebufferStatus)(GLenum);
static void (*glClampColor)(GLenum, GLuint);
static void (*glClearBufferfi)(GLenum, GLint, GLfloat, GLint);
static void (*glClipControl)(GLenum, GLenum);
static void (*glDepthMask)(GLboolean);
static void (*glDisable)(GLenum);
static void (*glDrawBuffers)(GLint, const GLenum *);
static void (*glEnable)(GLenum);
static void (*glEnableVertexAttribArray)(GLuint);
static void (*glFinish)(void);
static void (*glFlush)(void);
static void (*glFramebufferTexture2D)(GLenum, GLenum, GLenum, GLuint, GLint);
static void (*glGenFramebuffers)(GLint, GLuint *);
static void (*glGenTextures)(GLint, GLuint *);
static void (*glGenVertexArrays)(GLint, GLuint *);
static void (*glPixelStorei)(GLenum, GLint);
static void (*glReadBuffer)(GLenum);
static void (*glReadPixels)(GLint, GLint, GLint, GLint, GLenum, GLenum, void *);
static void (*glStencilMask)(GLuint);
static void (*glTexImage2D)(GLenum, GLint, GLenum, GLint, GLint, GLint, GLenum, GLenum, const void *);
static void (*glTexParameteri)(GLenum, GLenum, GLint);

static GLenum (*glGetError)(void);
static const unsigned char *(*glGetString)(GLenum);
static void (*glGetShaderiv)(GLuint, GLenum, GLint *);
static void (*glGetProgramiv)(GLuint, GLenum, GLint *);
static void (*glGetShaderInfoLog)(GLuint, GLint, GLint *, char *);
static void (*glGetProgramInfoLog)(GLuint, GLint, GLint *, char *);

/* Ends the program if the last call has failed. */
static void check(const char *call, int line)
{
    GLenum error = glGetError();
    if (error) {
        printf("line %d: %s: GL error 0x%04x\n", line, call, error);
        exit(FAILED);
    }
}
#define CALL(call) ((call), check(#call, __LINE__))

/* Ends the program if the driver does not support a framebuffer. */
static void complete(GLenum status, int line)
{
    if (status != 0x8CD5) {
        printf("line %d: the framebuffer is not complete: 0x%04x\n", line, status);
        exit(LACKS);
    }
}

static const char *const default_library = "libEGL.so.1";
static const int es = 0, major = 4, minor = 6, device = -1;
static const char *const api = "OpenGL 4.6";

static void *(*eglGetProcAddress)(const char *);
static void load(void);

static void lacks(const char *what)
{
    printf("not supported: %s\n", what);
    exit(LACKS);
}

static void *function(const char *name)
{
    void *address = eglGetProcAddress(name);
    if (!address)
        lacks(name);
    return address;
}

static void *display_of_device(const char *known)
{
    void *(*get)(unsigned, void *, const int32_t *);
    unsigned (*query)(int32_t, void **, int32_t *);
    void *all[64];
    int32_t number = 0;
    if (!strstr(known, "EGL_EXT_platform_device"))
        lacks("EGL_EXT_platform_device");
    *(void **)&get = function("eglGetPlatformDisplayEXT");
    *(void **)&query = function("eglQueryDevicesEXT");
    if (!query(64, all, &number) || device >= number)
        lacks("the EGL device");
    return get(0x313F, all[device], NULL);
}

static void make_context(const char *name)
{
    void *library = dlopen(name, RTLD_NOW | RTLD_GLOBAL);
    const char *(*query)(void *, int32_t);
    void *(*get_display)(void *);
    void *(*get_platform_display)(unsigned, void *, const int32_t *);
    unsigned (*initialize)(void *, int32_t *, int32_t *);
    unsigned (*bind)(unsigned);
    unsigned (*choose)(void *, const int32_t *, void **, int32_t, int32_t *);
    void *(*create)(void *, void *, void *, const int32_t *);
    unsigned (*make_current)(void *, void *, void *, void *);
    const char *known;
    void *display, *context, *config = NULL;
    int32_t version[2], number = 0;
    int32_t surfaceless[] = { 0x3033, 0, 0x3040, es ? 0x40 : 0x8, 0x3038 };
    int32_t list[] = { 0x3098, major, 0x30FB, minor, es ? 0x3038 : 0x30FD, 1, 0x3038 };
    if (!library)
        lacks(dlerror());
    *(void **)&eglGetProcAddress = dlsym(library, "eglGetProcAddress");
    *(void **)&query = dlsym(library, "eglQueryString");
    *(void **)&get_display = dlsym(library, "eglGetDisplay");
    *(void **)&initialize = dlsym(library, "eglInitialize");
    *(void **)&bind = dlsym(library, "eglBindAPI");
    *(void **)&choose = dlsym(library, "eglChooseConfig");
    *(void **)&create = dlsym(library, "eglCreateContext");
    *(void **)&make_current = dlsym(library, "eglMakeCurrent");
    if (!eglGetProcAddress || !query || !get_display || !initialize || !bind || !choose || !create || !make_current)
        lacks("EGL 1.4");
    known = query(NULL, 0x3055);
    if (device >= 0) {
        display = display_of_device(known ? known : "");
    } else if (known && strstr(known, "EGL_MESA_platform_surfaceless")) {
        *(void **)&get_platform_display = function("eglGetPlatformDisplayEXT");
        display = get_platform_display(0x31DD, NULL, NULL);
    } else {
        display = get_display(NULL);
    }
    if (!display || !initialize(display, &version[0], &version[1]))
        lacks("an EGL display");
    known = query(display, 0x3055);
    if (!strstr(known, "EGL_KHR_surfaceless_context"))
        lacks("EGL_KHR_surfaceless_context");
    if (!bind(es ? 0x30A0 : 0x30A2))
        lacks(api);
    if (!strstr(known, "EGL_KHR_no_config_context") && !strstr(known, "EGL_MESA_configless_context")
        && (!choose(display, surfaceless, &config, 1, &number) || number < 1))
        lacks("an EGL config");
    context = create(display, config, NULL, list);
    if (!context || !make_current(display, NULL, NULL, context))
        lacks(api);
    load();
    printf("%s, %s\n", glGetString(0x1F01), glGetString(0x1F02));
}

static void load(void)
{
    *(void **)&glGetError = function("glGetError");
    *(void **)&glGetString = function("glGetString");
    *(void **)&glGetShaderiv = function("glGetShaderiv");
    *(void **)&glGetProgramiv = function("glGetProgramiv");
    *(void **)&glGetShaderInfoLog = function("glGetShaderInfoLog");
    *(void **)&glGetProgramInfoLog = function("glGetProgramInfoLog");
    *(void **)&glActiveTexture = function("glActiveTexture");
    *(void **)&glBindBuffer = function("glBindBuffer");
    *(void **)&glBindFramebuffer = function("glBindFramebuffer");
    *(void **)&glBindTexture = function("glBindTexture");
    *(void **)&glBindVertexArray = function("glBindVertexArray");
    *(void **)&glCheckFramebufferStatus = function("glCheckFramebufferStatus");
    *(void **)&glClampColor = function("glClampColor");
    *(void **)&glClearBufferfi = function("glClearBufferfi");
    *(void **)&glClipControl = function("glClipControl");
    *(void **)&glDepthMask = function("glDepthMask");
    *(void **)&glDisable = function("glDisable");
    *(void **)&glDrawBuffers = function("glDrawBuffers");
    *(void **)&glEnable = function("glEnable");
    *(void **)&glEnableVertexAttribArray = function("glEnableVertexAttribArray");
    *(void **)&glFinish = function("glFinish");
    *(void **)&glFlush = function("glFlush");
    *(void **)&glFramebufferTexture2D = function("glFramebufferTexture2D");
    *(void **)&glGenFramebuffers = function("glGenFramebuffers");
    *(void **)&glGenTextures = function("glGenTextures");
    *(void **)&glGenVertexArrays = function("glGenVertexArrays");
    *(void **)&glPixelStorei = function("glPixelStorei");
    *(void **)&glReadBuffer = function("glReadBuffer");
    *(void **)&glReadPixels = function("glReadPixels");
    *(void **)&glStencilMask = function("glStencilMask");
    *(void **)&glTexImage2D = function("glTexImage2D");
    *(void **)&glTexParameteri = function("glTexParameteri");
}

static GLuint vertex_array_1;
static GLuint vertex_array_2;
static GLuint texture_1;
static GLuint framebuffer_1;
static GLuint framebuffer_2;
static unsigned char memory_0[4];

static void prepare(void)
{
    CALL(glGenVertexArrays(1, &vertex_array_1));
    CALL(glGenVertexArrays(1, &vertex_array_2));
    CALL(glBindVertexArray(vertex_array_2));
    CALL(glEnableVertexAttribArray(0));
    CALL(glEnableVertexAttribArray(1));
    CALL(glEnableVertexAttribArray(2));
    CALL(glDisable(GL_DITHER));
    CALL(glEnable(GL_FRAMEBUFFER_SRGB));
    CALL(glClampColor(GL_CLAMP_READ_COLOR, 0));
    CALL(glStencilMask(255));
    CALL(glPixelStorei(GL_PACK_ALIGNMENT, 1));
    CALL(glPixelStorei(GL_UNPACK_ALIGNMENT, 1));
    CALL(glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE));
    CALL(glGenTextures(1, &texture_1));
    CALL(glActiveTexture(GL_TEXTURE0));
    CALL(glBindTexture(GL_TEXTURE_2D, texture_1));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE));
    CALL(glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, 1, 1, 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, NULL));
    CALL(glGenFramebuffers(1, &framebuffer_1));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_1));
    CALL(glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, texture_1, 0));
    CALL(glDrawBuffers(1, (const GLenum[]){ GL_NONE }));
    CALL(glReadBuffer(GL_NONE));
    complete(glCheckFramebufferStatus(GL_FRAMEBUFFER), __LINE__);
    CALL(glGenFramebuffers(1, &framebuffer_2));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_2));
    CALL(glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, texture_1, 0));
    CALL(glDrawBuffers(1, (const GLenum[]){ GL_NONE }));
    CALL(glReadBuffer(GL_NONE));
    complete(glCheckFramebufferStatus(GL_FRAMEBUFFER), __LINE__);
}

static void draw(void)
{
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_1));
    CALL(glClearBufferfi(GL_DEPTH_STENCIL, 0, 1.0f, 0));
    CALL(glBindVertexArray(vertex_array_2));
    CALL(glBindBuffer(GL_ARRAY_BUFFER, 0));
    CALL(glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_2));
    CALL(glDepthMask(0));
    CALL(glStencilMask(1));
    CALL(glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0f, 1));
    CALL(glFlush());
    CALL(glFinish());
}

static void read_back(void)
{
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_1));
    CALL(glPixelStorei(GL_PACK_ROW_LENGTH, 1));
    CALL(glReadPixels(0, 0, 1, 1, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, memory_0));
}

/* How the bits of a channel are compared: as a number, a signed number, a float of 16 bits (by its sign and magnitude),
 * a float of 32 bits, or a byte that a shorter code was widened to. */
enum order { UNSIGNED, SIGNED, HALF, SINGLE, VALUE, WIDENED };

struct channel {
    const char *name;
    const unsigned char *texel;
    unsigned bit, bits;
    enum order order;
    unsigned width;
};

struct range {
    double least, most;
};

struct texel {
    const char *place;
    unsigned channels, outcomes;
    const struct channel *channel;
    const struct range *allowed;
};

static double value_of(const struct channel *c)
{
    uint64_t word = 0;
    uint32_t code, sign;
    float value;
    memcpy(&word, c->texel + c->bit / 8, (c->bit % 8 + c->bits + 7) / 8);
    code = (uint32_t)(word >> c->bit % 8) & (0xFFFFFFFFu >> (32 - c->bits));
    sign = 1u << (c->width - 1);
    switch (c->order) {
    case SIGNED:
        return (code & sign) ? (double)code - 2.0 * sign : code;
    case HALF:
    case SINGLE:
        return (code & sign) ? -(double)(code - sign) : code;
    case VALUE:
        memcpy(&value, &code, sizeof value);
        return value;
    case WIDENED:
        return (code * ((1u << c->width) - 1) + 127) / 255;
    default:
        return code;
    }
}

static int is_allowed(const struct texel *t, const struct range *outcome)
{
    unsigned i;
    for (i = 0; i < t->channels; i++) {
        double value = value_of(&t->channel[i]);
        if (!(value >= outcome[i].least && value <= outcome[i].most))
            return 0;
    }
    return 1;
}

static int is_right(const struct texel *t)
{
    unsigned i;
    for (i = 0; i < t->outcomes; i++)
        if (is_allowed(t, t->allowed + i * t->channels))
            return 1;
    return 0;
}

/* The number that a place in the order stands for. */
static double shown(const struct channel *c, double order)
{
    double sign = order < 0 ? -1 : 1, size = fabs(order);
    uint32_t code = size < 0x7F800000 ? (uint32_t)size : 0x7F800000;
    float value;
    if (c->order == SINGLE) {
        memcpy(&value, &code, sizeof value);
        return sign * (double)value;
    }
    if (c->order == HALF && size < 0x7C00)
        return sign * (code < 0x400 ? ldexp(code, -24) : ldexp(code % 0x400 + 0x400, (int)(code / 0x400) - 25));
    return c->order == HALF ? sign * INFINITY : order;
}

static void tell(const struct texel *t)
{
    unsigned i;
    printf("%s is wrong:", t->place);
    for (i = 0; i < t->channels; i++) {
        const struct channel *c = &t->channel[i];
        double value = value_of(c);
        double least = t->allowed[i].least, most = t->allowed[i].most;
        if (t->outcomes == 1 && value >= least && value <= most)
            continue;
        printf(" %s %.9g", c->name, shown(c, value));
        if (t->outcomes != 1)
            continue;
        if (least == most)
            printf(" (must be %.9g)", shown(c, least));
        else if (isinf(most))
            printf(" (must be at least %.9g)", shown(c, least));
        else if (isinf(least))
            printf(" (must be at most %.9g)", shown(c, most));
        else
            printf(" (must be %.9g to %.9g)", shown(c, least), shown(c, most));
    }
    printf("\n");
}

static const struct channel channels_0[] = {
    { "depth of depth", memory_0 + 0, 8, 24, UNSIGNED, 24 },
    { "stencil of depth", memory_0 + 0, 0, 8, UNSIGNED, 8 },
};
static const struct range allowed_0[] = {
    { 16777215.0, 16777215.0 }, { 1.0, 1.0 },
};

static int check_values(void)
{
    static const struct texel all[] = {
        { "texel 0,0", 2, 1, channels_0, allowed_0 },
    };
    unsigned i;
    for (i = 0; i < sizeof all / sizeof *all; i++)
        if (!is_right(&all[i])) {
            tell(&all[i]);
            return BUG;
        }
    printf("right\n");
    return 0;
}

int main(int count, char **arguments)
{
    make_context(count > 1 ? arguments[1] : default_library);
    prepare();
    draw();
    read_back();
    return check_values();
}
