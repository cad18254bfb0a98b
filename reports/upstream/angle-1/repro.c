/*
 * ANGLE/Vulkan: polygon offset units vanish near depth 0 if D24 is emulated by a float format (with GL_ZERO_TO_ONE_EXT)
 *
 * Build and run:
 *   cc repro.c -ldl -o repro
 *   LD_LIBRARY_PATH="$ANGLE" ANGLE_DEFAULT_PLATFORM=swiftshader ./repro "$ANGLE/libEGL.so"
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

#define GL_ALWAYS 0x0207
#define GL_ARRAY_BUFFER 0x8892
#define GL_CLAMP_TO_EDGE 0x812F
#define GL_COLOR_ATTACHMENT0 0x8CE0
#define GL_DEPTH24_STENCIL8 0x88F0
#define GL_DEPTH_COMPONENT 0x1902
#define GL_DEPTH_STENCIL 0x84F9
#define GL_DEPTH_STENCIL_ATTACHMENT 0x821A
#define GL_DEPTH_STENCIL_TEXTURE_MODE 0x90EA
#define GL_DEPTH_TEST 0x0B71
#define GL_DITHER 0x0BD0
#define GL_ELEMENT_ARRAY_BUFFER 0x8893
#define GL_FLOAT 0x1406
#define GL_FRAGMENT_SHADER 0x8B30
#define GL_FRAMEBUFFER 0x8D40
#define GL_NEAREST 0x2600
#define GL_NONE 0x0000
#define GL_PACK_ALIGNMENT 0x0D05
#define GL_PACK_ROW_LENGTH 0x0D02
#define GL_POLYGON_OFFSET_FILL 0x8037
#define GL_RGBA32UI 0x8D70
#define GL_RGBA_INTEGER 0x8D99
#define GL_STATIC_DRAW 0x88E4
#define GL_STENCIL_INDEX 0x1901
#define GL_TEXTURE0 0x84C0
#define GL_TEXTURE_2D 0x0DE1
#define GL_TEXTURE_BASE_LEVEL 0x813C
#define GL_TEXTURE_MAG_FILTER 0x2800
#define GL_TEXTURE_MAX_LEVEL 0x813D
#define GL_TEXTURE_MIN_FILTER 0x2801
#define GL_TEXTURE_WRAP_S 0x2802
#define GL_TEXTURE_WRAP_T 0x2803
#define GL_TRIANGLES 0x0004
#define GL_UNIFORM_BUFFER 0x8A11
#define GL_UNPACK_ALIGNMENT 0x0CF5
#define GL_UNSIGNED_INT 0x1405
#define GL_UNSIGNED_INT_24_8 0x84FA
#define GL_UPPER_LEFT 0x8CA2
#define GL_VERTEX_SHADER 0x8B31
#define GL_ZERO_TO_ONE 0x935F

static void (*glActiveTexture)(GLenum);
static void (*glAttachShader)(GLuint, GLuint);
static void (*glBindBuffer)(GLenum, GLuint);
static void (*glBindBufferRange)(GLenum, GLuint, GLuint, GLsizeiptr, GLsizeiptr);
static void (*glBindFramebuffer)(GLenum, GLuint);
static void (*glBindTexture)(GLenum, GLuint);
static void (*glBindVertexArray)(GLuint);
static void (*glBufferData)(GLenum, GLsizeiptr, const void *, GLenum);
static GLenum (*glCheckFramebufferStatus)(GLenum);
static void (*glClearBufferfi)(GLenum, GLint, GLfloat, GLint);
static void (*glClipControlEXT)(GLenum, GLenum);
static void (*glCompileShader)(GLuint);
static GLuint (*glCreateProgram)(void);
static GLuint (*glCreateShader)(GLenum);
static void (*glDepthFunc)(GLenum);
static void (*glDisable)(GLenum);
static void (*glDrawArrays)(GLenum, GLint, GLint);
static void (*glDrawBuffers)(GLint, const GLenum *);
static void (*glEnable)(GLenum);
static void (*glEnableVertexAttribArray)(GLuint);
static void (*glFinish)(void);
static void (*glFlush)(void);
static void (*glFramebufferTexture2D)(GLenum, GLenum, GLenum, GLuint, GLint);
static void (*glGenBuffers)(GLint, GLuint *);
static void (*glGenFramebuffers)(GLint, GLuint *);
static void (*glGenTextures)(GLint, GLuint *);
static void (*glGenVertexArrays)(GLint, GLuint *);
static GLuint (*glGetUniformBlockIndex)(GLuint, const char *);
static GLint (*glGetUniformLocation)(GLuint, const char *);
static void (*glLinkProgram)(GLuint);
static void (*glPixelStorei)(GLenum, GLint);
static void (*glPolygonOffset)(GLfloat, GLfloat);
static void (*glReadBuffer)(GLenum);
static void (*glReadPixels)(GLint, GLint, GLint, GLint, GLenum, GLenum, void *);
static void (*glShaderSource)(GLuint, GLint, const char *const *, const GLint *);
static void (*glStencilMask)(GLuint);
static void (*glTexImage2D)(GLenum, GLint, GLenum, GLint, GLint, GLint, GLenum, GLenum, const void *);
static void (*glTexParameteri)(GLenum, GLenum, GLint);
static void (*glUniform1i)(GLint, GLint);
static void (*glUniformBlockBinding)(GLuint, GLuint, GLuint);
static void (*glUseProgram)(GLuint);
static void (*glVertexAttribPointer)(GLuint, GLint, GLenum, GLboolean, GLint, const void *);
static void (*glViewport)(GLint, GLint, GLint, GLint);

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

/* Ends the program if a shader has not compiled or a program has not linked. */
static void built(void (*get)(GLuint, GLenum, GLint *), void (*get_log)(GLuint, GLint, GLint *, char *), GLuint object,
    GLenum status, const char *failure, int line)
{
    GLint done = 0;
    char log[2000] = "";
    get(object, status, &done);
    if (!done) {
        get_log(object, sizeof log, NULL, log);
        printf("line %d: %s: %s\n", line, failure, log);
        exit(FAILED);
    }
}
#define compiled(shader, line) \
    built(glGetShaderiv, glGetShaderInfoLog, shader, 0x8B81, "the shader does not compile", line)
#define linked(program, line) \
    built(glGetProgramiv, glGetProgramInfoLog, program, 0x8B82, "the program does not link", line)

/* Ends the program if the driver does not support a framebuffer. */
static void complete(GLenum status, int line)
{
    if (status != 0x8CD5) {
        printf("line %d: the framebuffer is not complete: 0x%04x\n", line, status);
        exit(LACKS);
    }
}

static const char *const default_library = "libEGL.so";
static const int es = 1, major = 3, minor = 1, device = -1;
static const char *const api = "OpenGL ES 3.1";

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
    *(void **)&glAttachShader = function("glAttachShader");
    *(void **)&glBindBuffer = function("glBindBuffer");
    *(void **)&glBindBufferRange = function("glBindBufferRange");
    *(void **)&glBindFramebuffer = function("glBindFramebuffer");
    *(void **)&glBindTexture = function("glBindTexture");
    *(void **)&glBindVertexArray = function("glBindVertexArray");
    *(void **)&glBufferData = function("glBufferData");
    *(void **)&glCheckFramebufferStatus = function("glCheckFramebufferStatus");
    *(void **)&glClearBufferfi = function("glClearBufferfi");
    *(void **)&glClipControlEXT = function("glClipControlEXT");
    *(void **)&glCompileShader = function("glCompileShader");
    *(void **)&glCreateProgram = function("glCreateProgram");
    *(void **)&glCreateShader = function("glCreateShader");
    *(void **)&glDepthFunc = function("glDepthFunc");
    *(void **)&glDisable = function("glDisable");
    *(void **)&glDrawArrays = function("glDrawArrays");
    *(void **)&glDrawBuffers = function("glDrawBuffers");
    *(void **)&glEnable = function("glEnable");
    *(void **)&glEnableVertexAttribArray = function("glEnableVertexAttribArray");
    *(void **)&glFinish = function("glFinish");
    *(void **)&glFlush = function("glFlush");
    *(void **)&glFramebufferTexture2D = function("glFramebufferTexture2D");
    *(void **)&glGenBuffers = function("glGenBuffers");
    *(void **)&glGenFramebuffers = function("glGenFramebuffers");
    *(void **)&glGenTextures = function("glGenTextures");
    *(void **)&glGenVertexArrays = function("glGenVertexArrays");
    *(void **)&glGetUniformBlockIndex = function("glGetUniformBlockIndex");
    *(void **)&glGetUniformLocation = function("glGetUniformLocation");
    *(void **)&glLinkProgram = function("glLinkProgram");
    *(void **)&glPixelStorei = function("glPixelStorei");
    *(void **)&glPolygonOffset = function("glPolygonOffset");
    *(void **)&glReadBuffer = function("glReadBuffer");
    *(void **)&glReadPixels = function("glReadPixels");
    *(void **)&glShaderSource = function("glShaderSource");
    *(void **)&glStencilMask = function("glStencilMask");
    *(void **)&glTexImage2D = function("glTexImage2D");
    *(void **)&glTexParameteri = function("glTexParameteri");
    *(void **)&glUniform1i = function("glUniform1i");
    *(void **)&glUniformBlockBinding = function("glUniformBlockBinding");
    *(void **)&glUseProgram = function("glUseProgram");
    *(void **)&glVertexAttribPointer = function("glVertexAttribPointer");
    *(void **)&glViewport = function("glViewport");
}

static GLuint vertex_array_1;
static GLuint vertex_array_2;
static GLuint texture_1;
static GLuint framebuffer_1;
static GLuint buffer_1;
static GLuint buffer_2;
static GLuint framebuffer_2;
static GLuint program_1;
static GLuint shader_1;
static GLuint shader_2;
static GLuint block_1;
static GLuint program_2;
static GLuint shader_3;
static GLuint shader_4;
static GLint location_1;
static GLuint texture_2;
static GLuint framebuffer_3;
static GLuint program_3;
static GLuint shader_5;
static GLuint shader_6;
static GLint location_2;
static unsigned char memory_0[16];
static unsigned char memory_1[16];
static const GLfloat data_1[60] = {
    -1.0f, -0.5f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, -1.0f,
    0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.5f, 1.0f, 0.0f, 1.0f,
    0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, -1.0f, -0.5f, 0.0f, 1.0f, 0.0f, 0.0f,
    0.0f, 0.0f, 0.0f, 0.0f, 0.5f, 1.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f,
    0.0f, 0.0f, -1.0f, 1.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f,
};
static const unsigned char data_2[256];
static const char *const source_3 =
    "#version 310 es\n"
    "\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "\n"
    "struct Params {\n"
    "    vec4 color;\n"
    "    vec4 back_color;\n"
    "};\n"
    "layout(location = 0) in vec4 _p2vs_location0;\n"
    "\n"
    "void main() {\n"
    "    vec4 position = _p2vs_location0;\n"
    "    gl_Position = position;\n"
    "    gl_PointSize = 1.0;\n"
    "    return;\n"
    "}\n"
    "\n";
static const char *const source_4 =
    "#version 310 es\n"
    "\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "\n"
    "struct Params {\n"
    "    vec4 color;\n"
    "    vec4 back_color;\n"
    "};\n"
    "layout(std140) uniform Params_block_0Fragment { Params _group_0_binding_0_fs; };\n"
    "\n"
    "layout(location = 0) out vec4 _fs2p_location0;\n"
    "\n"
    "void main() {\n"
    "    vec4 _e2 = _group_0_binding_0_fs.color;\n"
    "    _fs2p_location0 = _e2;\n"
    "    return;\n"
    "}\n"
    "\n";
static const char *const source_5 =
    "#version 310 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "void main() {\n"
    "vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n"
    "gl_Position = vec4(corner * 4.0 - 1.0, 0.5, 1.0);\n"
    "}\n";
static const char *const source_6 =
    "#version 310 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "uniform highp sampler2D source;\n"
    "uniform highp int number;\n"
    "layout(location = 0) out highp uvec4 value;\n"
    "void main() {\n"
    "value = floatBitsToUint(texelFetch(source, ivec2(gl_FragCoord.xy), 0));\n"
    "}\n";
static const char *const source_7 =
    "#version 310 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "void main() {\n"
    "vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));\n"
    "gl_Position = vec4(corner * 4.0 - 1.0, 0.5, 1.0);\n"
    "}\n";
static const char *const source_8 =
    "#version 310 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "uniform highp usampler2D source;\n"
    "uniform highp int number;\n"
    "layout(location = 0) out highp uvec4 value;\n"
    "void main() {\n"
    "value = texelFetch(source, ivec2(gl_FragCoord.xy), 0);\n"
    "}\n";

static void prepare(void)
{
    CALL(glGenVertexArrays(1, &vertex_array_1));
    CALL(glGenVertexArrays(1, &vertex_array_2));
    CALL(glBindVertexArray(vertex_array_2));
    CALL(glEnableVertexAttribArray(0));
    CALL(glEnableVertexAttribArray(1));
    CALL(glEnableVertexAttribArray(2));
    CALL(glDisable(GL_DITHER));
    CALL(glStencilMask(255));
    CALL(glPixelStorei(GL_PACK_ALIGNMENT, 1));
    CALL(glPixelStorei(GL_UNPACK_ALIGNMENT, 1));
    CALL(glClipControlEXT(GL_UPPER_LEFT, GL_ZERO_TO_ONE));
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
    CALL(glGenBuffers(1, &buffer_1));
    CALL(glBindBuffer(GL_ARRAY_BUFFER, buffer_1));
    CALL(glBufferData(GL_ARRAY_BUFFER, 240, data_1, GL_STATIC_DRAW));
    CALL(glGenBuffers(1, &buffer_2));
    CALL(glBindBuffer(GL_ARRAY_BUFFER, buffer_2));
    CALL(glBufferData(GL_ARRAY_BUFFER, 256, data_2, GL_STATIC_DRAW));
    CALL(glGenFramebuffers(1, &framebuffer_2));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_2));
    CALL(glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, texture_1, 0));
    CALL(glDrawBuffers(1, (const GLenum[]){ GL_NONE }));
    CALL(glReadBuffer(GL_NONE));
    complete(glCheckFramebufferStatus(GL_FRAMEBUFFER), __LINE__);
    program_1 = glCreateProgram(), check("glCreateProgram", __LINE__);
    shader_1 = glCreateShader(GL_VERTEX_SHADER), check("glCreateShader", __LINE__);
    CALL(glShaderSource(shader_1, 1, &source_3, NULL));
    CALL(glCompileShader(shader_1)), compiled(shader_1, __LINE__);
    CALL(glAttachShader(program_1, shader_1));
    shader_2 = glCreateShader(GL_FRAGMENT_SHADER), check("glCreateShader", __LINE__);
    CALL(glShaderSource(shader_2, 1, &source_4, NULL));
    CALL(glCompileShader(shader_2)), compiled(shader_2, __LINE__);
    CALL(glAttachShader(program_1, shader_2));
    CALL(glLinkProgram(program_1)), linked(program_1, __LINE__);
    CALL(glUseProgram(program_1));
    block_1 = glGetUniformBlockIndex(program_1, "Params_block_0Fragment"), check("glGetUniformBlockIndex", __LINE__);
    CALL(glUniformBlockBinding(program_1, block_1, 0));
}

static void draw(void)
{
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_1));
    CALL(glClearBufferfi(GL_DEPTH_STENCIL, 0, 1.0f, 0));
    CALL(glBindVertexArray(vertex_array_2));
    CALL(glBindBuffer(GL_ARRAY_BUFFER, buffer_1));
    CALL(glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0));
    CALL(glVertexAttribPointer(0, 4, GL_FLOAT, 0, 40, NULL));
    CALL(glVertexAttribPointer(1, 4, GL_FLOAT, 0, 40, (const void *)16));
    CALL(glVertexAttribPointer(2, 2, GL_FLOAT, 0, 40, (const void *)32));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_2));
    CALL(glEnable(GL_POLYGON_OFFSET_FILL));
    CALL(glPolygonOffset(0.0f, 255.0f));
    CALL(glViewport(0, 0, 1, 1));
    CALL(glEnable(GL_DEPTH_TEST));
    CALL(glDepthFunc(GL_ALWAYS));
    CALL(glUseProgram(program_1));
    CALL(glBindBufferRange(GL_UNIFORM_BUFFER, 0, buffer_2, 0, 32));
    CALL(glDrawArrays(GL_TRIANGLES, 0, 6));
    CALL(glFlush());
    CALL(glFinish());
}

static void read_back(void)
{
    program_2 = glCreateProgram(), check("glCreateProgram", __LINE__);
    shader_3 = glCreateShader(GL_VERTEX_SHADER), check("glCreateShader", __LINE__);
    CALL(glShaderSource(shader_3, 1, &source_5, NULL));
    CALL(glCompileShader(shader_3)), compiled(shader_3, __LINE__);
    CALL(glAttachShader(program_2, shader_3));
    shader_4 = glCreateShader(GL_FRAGMENT_SHADER), check("glCreateShader", __LINE__);
    CALL(glShaderSource(shader_4, 1, &source_6, NULL));
    CALL(glCompileShader(shader_4)), compiled(shader_4, __LINE__);
    CALL(glAttachShader(program_2, shader_4));
    CALL(glLinkProgram(program_2)), linked(program_2, __LINE__);
    CALL(glUseProgram(program_2));
    location_1 = glGetUniformLocation(program_2, "source"), check("glGetUniformLocation", __LINE__);
    CALL(glUniform1i(location_1, 0));
    CALL(glGetUniformLocation(program_2, "number"));
    CALL(glGenTextures(1, &texture_2));
    CALL(glActiveTexture(GL_TEXTURE0));
    CALL(glBindTexture(GL_TEXTURE_2D, texture_2));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE));
    CALL(glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, 1, 1, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, NULL));
    CALL(glGenFramebuffers(1, &framebuffer_3));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_3));
    CALL(glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_2, 0));
    CALL(glDrawBuffers(1, (const GLenum[]){ GL_COLOR_ATTACHMENT0 }));
    CALL(glReadBuffer(GL_COLOR_ATTACHMENT0));
    complete(glCheckFramebufferStatus(GL_FRAMEBUFFER), __LINE__);
    CALL(glDisable(GL_DEPTH_TEST));
    CALL(glDisable(GL_POLYGON_OFFSET_FILL));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_3));
    CALL(glViewport(0, 0, 1, 1));
    CALL(glUseProgram(program_2));
    CALL(glBindVertexArray(vertex_array_1));
    CALL(glActiveTexture(GL_TEXTURE0));
    CALL(glBindTexture(GL_TEXTURE_2D, texture_1));
    CALL(glDrawArrays(GL_TRIANGLES, 0, 3));
    CALL(glPixelStorei(GL_PACK_ROW_LENGTH, 1));
    CALL(glReadPixels(0, 0, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, memory_0));
    CALL(glPixelStorei(GL_PACK_ROW_LENGTH, 0));
    program_3 = glCreateProgram(), check("glCreateProgram", __LINE__);
    shader_5 = glCreateShader(GL_VERTEX_SHADER), check("glCreateShader", __LINE__);
    CALL(glShaderSource(shader_5, 1, &source_7, NULL));
    CALL(glCompileShader(shader_5)), compiled(shader_5, __LINE__);
    CALL(glAttachShader(program_3, shader_5));
    shader_6 = glCreateShader(GL_FRAGMENT_SHADER), check("glCreateShader", __LINE__);
    CALL(glShaderSource(shader_6, 1, &source_8, NULL));
    CALL(glCompileShader(shader_6)), compiled(shader_6, __LINE__);
    CALL(glAttachShader(program_3, shader_6));
    CALL(glLinkProgram(program_3)), linked(program_3, __LINE__);
    CALL(glUseProgram(program_3));
    location_2 = glGetUniformLocation(program_3, "source"), check("glGetUniformLocation", __LINE__);
    CALL(glUniform1i(location_2, 0));
    CALL(glGetUniformLocation(program_3, "number"));
    CALL(glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_3));
    CALL(glViewport(0, 0, 1, 1));
    CALL(glUseProgram(program_3));
    CALL(glBindVertexArray(vertex_array_1));
    CALL(glActiveTexture(GL_TEXTURE0));
    CALL(glBindTexture(GL_TEXTURE_2D, texture_1));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_STENCIL_INDEX));
    CALL(glDrawArrays(GL_TRIANGLES, 0, 3));
    CALL(glTexParameteri(GL_TEXTURE_2D, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_DEPTH_COMPONENT));
    CALL(glPixelStorei(GL_PACK_ROW_LENGTH, 1));
    CALL(glReadPixels(0, 0, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, memory_1));
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
    { "depth of depth", memory_0 + 0, 0, 32, VALUE, 32 },
    { "stencil of depth", memory_1 + 0, 0, 32, UNSIGNED, 8 },
};
static const struct range allowed_0[] = {
    { 1.5139428796828724e-5, 1.0 }, { 0.0, 0.0 },
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
