//! OpenGL and OpenGL ES: one C file that loads EGL and needs no headers of the API.

mod calls;
mod trim;

use crate::c::string;
use crate::check;
use crate::due::Due;
use crate::error::BundleError;
use crate::head::Head;
use crate::language::BUILD_C;
use calls::Printer;
use etalon_backend::Recording;
use trim::trimmed;

pub use trim::Trim;

/// The EGL context that a program creates.
pub(crate) struct ProgramContext<'a> {
    /// True for OpenGL ES.
    pub(crate) es: bool,
    /// Major and minor version.
    pub(crate) version: [u32; 2],
    /// The EGL library, if it is not the system's.
    pub(crate) library: Option<&'a str>,
    /// The index of the EGL device; `None` for the surfaceless platform.
    pub(crate) device: Option<u32>,
}

/// Returns the program.
pub(crate) fn program(
    head: &Head,
    context: &ProgramContext<'_>,
    recording: &Recording,
    expected: &Due,
    trim: Trim,
) -> Result<String, BundleError> {
    let ProgramContext {
        es,
        version: [major, minor],
        library,
        device,
    } = *context;
    let api = if es { "OpenGL ES" } else { "OpenGL" };
    let mut printer = Printer::default();
    let body = printer.body(&trimmed(&recording.calls, trim))?;
    let check = check::check(recording, expected)?;
    let mut text = head.beginning(BUILD_C, "the EGL library to load", "");
    text.push_str(TYPES);
    text.push_str(&printer.constants());
    text.push_str(&printer.declarations.functions());
    text.push_str(HELPERS);
    let calls = &body.definitions;
    let built = calls.contains("compiled(") || calls.contains("linked(");
    for (used, helper) in [
        (built, BUILT),
        (calls.contains("copy("), COPY),
        (calls.contains("complete("), COMPLETE),
    ] {
        if used {
            text.push_str(helper);
        }
    }
    text.push_str(&format!(
        "\nstatic const char *const default_library = {};\n\
         static const int es = {}, major = {major}, minor = {minor}, device = {};\n\
         static const char *const api = \"{api} {major}.{minor}\";\n",
        string(library.unwrap_or("libEGL.so.1")),
        i32::from(es),
        device.map_or(-1, i64::from),
    ));
    text.push_str(CONTEXT);
    text.push_str(&printer.declarations.load("load(void)", "function(", &OWN));
    text.push_str(&printer.declarations.variables());
    text.push_str(&body.definitions);
    text.push_str(&check);
    text.push_str(&format!(
        "\nint main(int count, char **arguments)\n{{\n    make_context(count > 1 ? arguments[1] : default_library);\n{}    return \
         check_values();\n}}\n",
        body.calls
    ));
    Ok(text)
}

/// The functions that [`HELPERS`] declares.
const OWN: [&str; 6] = [
    "glGetError",
    "glGetString",
    "glGetShaderiv",
    "glGetProgramiv",
    "glGetShaderInfoLog",
    "glGetProgramInfoLog",
];

/// The types of the API.
const TYPES: &str = r#"
typedef unsigned int GLenum;
typedef unsigned int GLuint;
typedef int GLint;
typedef unsigned char GLboolean;
typedef float GLfloat;
typedef double GLdouble;
typedef intptr_t GLsizeiptr;

"#;

/// The error check after each call.
const HELPERS: &str = r#"
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
"#;

/// The checks of shaders and programs.
const BUILT: &str = r#"
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
"#;

/// The function that copies a mapped buffer.
const COPY: &str = r#"
/* Copies a mapped buffer. */
static void copy(unsigned char *to, const void *from, size_t size, int line)
{
    check("glMapBufferRange", line);
    if (!from)
        exit(FAILED);
    memcpy(to, from, size);
}
"#;

/// The function that checks a framebuffer.
const COMPLETE: &str = r#"
/* Ends the program if the driver does not support a framebuffer. */
static void complete(GLenum status, int line)
{
    if (status != 0x8CD5) {
        printf("line %d: the framebuffer is not complete: 0x%04x\n", line, status);
        exit(LACKS);
    }
}
"#;

/// The functions that create a context without a surface and load its functions.
const CONTEXT: &str = r#"
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
"#;
