/* A renderer in plain C that speaks etalon's open protocol: depth, blending, scissor, culling, one and four samples.
 *
 *     cc -O2 -o loop loop.c -lm
 *     { "name": "external:loop", "backend": "external", "command": ["./loop"] }
 *
 * The argument `upside-down`, `srgb-twice` or `one-sample` makes a mistake, which `etalon conformance` must name. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *HELLO =
    "{\"protocol\":1,\"device\":\"the processor\",\"driver\":\"loop.c\",\"driver_version\":\"1\",\"software\":true,"
    "\"rules\":\"vulkan\",\"version\":\"1.0\",\"sub_pixel_bits\":8,\"max_size\":4096,\"max_color_attachments\":1,"
    "\"formats\":{\"rgba8unorm\":{\"samples\":[1,4],\"blendable\":true},"
    "\"rgba8unorm-srgb\":{\"samples\":[1,4],\"blendable\":true},\"depth32float\":{\"samples\":[1,4]}},"
    "\"features\":[\"precise-occlusion\"]}";

static int upside_down, srgb_twice, one_sample;

/* JSON: a value is a pointer to its first character. */

static const char *blank(const char *p) { return p + strspn(p, " \t\r\n"); }

static const char *after(const char *p) {
    int depth = 0;
    p = blank(p);
    do {
        if (*p == '"') {
            for (p++; *p && *p != '"'; p++)
                if (*p == '\\') p++;
            p++;
        } else if (*p == '{' || *p == '[') {
            depth++, p++;
        } else if (*p == '}' || *p == ']') {
            depth--, p++;
        } else if (*p == ',' || *p == ':' || strchr(" \t\r\n", *p)) {
            p++;
        } else {
            p += strcspn(p, ",:{}[]\" \t\r\n");
        }
    } while (depth && *p);
    return blank(p);
}

/* Returns the first value of a list, the one after a value, and the one at an index; 0 if there is none. */
static const char *first(const char *list) {
    const char *p = blank(blank(list) + 1);
    return *p == ']' ? 0 : p;
}
static const char *next(const char *value) {
    const char *p = after(value);
    return *p == ',' ? blank(p + 1) : 0;
}
static const char *item(const char *list, int index) {
    const char *p = first(list);
    while (p && index--) p = next(p);
    return p;
}

/* Returns the value of a key of an object; 0 if it has none, or null. */
static const char *get(const char *object, const char *key) {
    size_t length = strlen(key);
    const char *p = blank(blank(object) + 1);
    while (*p == '"') {
        const char *value = blank(after(p) + 1);
        if (!strncmp(p + 1, key, length) && p[1 + length] == '"') return *value == 'n' ? 0 : value;
        p = after(value);
        p = *p == ',' ? blank(p + 1) : p;
    }
    return 0;
}

static double number(const char *value) { return strtod(value, 0); }
static int is(const char *value, const char *text) {
    return value && *value == '"' && !strncmp(value + 1, text, strlen(text)) && value[1 + strlen(text)] == '"';
}
static void numbers(const char *list, int count, double *out) {
    const char *p = first(list);
    for (int i = 0; p && i < count; i++, p = next(p)) out[i] = number(p);
}

/* Base64. */

static const char *DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static size_t decode(const char *value, uint8_t *out) {
    size_t length = 0;
    uint32_t bits = 0;
    int count = 0;
    for (const char *p = value + 1; *p != '"' && *p != '='; p++) {
        bits = bits << 6 | (uint32_t)(strchr(DIGITS, *p) - DIGITS);
        count += 6;
        if (count >= 8) out[length++] = (uint8_t)(bits >> (count -= 8));
    }
    return length;
}

static void encode(const uint8_t *bytes, size_t length) {
    for (size_t i = 0; i < length; i += 3) {
        uint32_t b = (uint32_t)bytes[i] << 16;
        if (i + 1 < length) b |= (uint32_t)bytes[i + 1] << 8;
        if (i + 2 < length) b |= bytes[i + 2];
        putchar(DIGITS[b >> 18]);
        putchar(DIGITS[b >> 12 & 63]);
        putchar(i + 1 < length ? DIGITS[b >> 6 & 63] : '=');
        putchar(i + 2 < length ? DIGITS[b & 63] : '=');
    }
}

/* Attachments: four bytes a sample, a colour or a float. Samples of a texel are neighbours. */

typedef struct {
    int width, height, samples, is_depth, is_srgb;
    uint8_t *bytes;
} Image;

static const int POSITIONS[4][2] = {{96, 32}, {224, 96}, {32, 160}, {160, 224}};

static double clamped(double v) { return v < 0 ? 0 : v > 1 ? 1 : v; }
static double to_srgb(double v) { return v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1 / 2.4) - 0.055; }
static double to_linear(double v) { return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4); }

static void load(const Image *image, const uint8_t *texel, double *color) {
    for (int c = 0; c < 4; c++) {
        color[c] = texel[c] / 255.0;
        if (image->is_srgb && c < 3) color[c] = to_linear(color[c]);
    }
}

static void store(const Image *image, uint8_t *texel, const double *color, int mask) {
    for (int c = 0; c < 4; c++) {
        double v = clamped(color[c]);
        if (image->is_srgb && c < 3) v = to_srgb(v);
        if (image->is_srgb && c < 3 && srgb_twice) v = to_srgb(v);
        if (mask >> c & 1) texel[c] = (uint8_t)floor(v * 255 + 0.5);
    }
}

static size_t samples_of(const Image *image) {
    return (size_t)image->width * (size_t)image->height * (size_t)image->samples;
}

static void clear(Image *image, const double *color) {
    for (size_t i = 0; i < samples_of(image); i++) {
        float depth = (float)color[0];
        if (image->is_depth) memcpy(image->bytes + 4 * i, &depth, 4);
        else store(image, image->bytes + 4 * i, color, 15);
    }
}

/* Blending. */

static double factor(const char *name, int c, const double *src, const double *dst, const double *constant) {
    if (is(name, "zero")) return 0;
    if (is(name, "one")) return 1;
    if (is(name, "src")) return src[c];
    if (is(name, "one-minus-src")) return 1 - src[c];
    if (is(name, "src-alpha")) return src[3];
    if (is(name, "one-minus-src-alpha")) return 1 - src[3];
    if (is(name, "dst")) return dst[c];
    if (is(name, "one-minus-dst")) return 1 - dst[c];
    if (is(name, "dst-alpha")) return dst[3];
    if (is(name, "one-minus-dst-alpha")) return 1 - dst[3];
    if (is(name, "src-alpha-saturated")) return c == 3 ? 1 : fmin(src[3], 1 - dst[3]);
    if (is(name, "constant")) return constant[c];
    if (is(name, "one-minus-constant")) return 1 - constant[c];
    if (is(name, "constant-alpha")) return constant[3];
    return 1 - constant[3];
}

static void blended(const char *blend, double *src, const double *dst, const double *constant) {
    double out[4];
    for (int c = 0; c < 4; c++) {
        const char *state = get(blend, c < 3 ? "color" : "alpha"), *operation = get(state, "operation");
        double s = src[c] * factor(get(state, "src_factor"), c, src, dst, constant);
        double d = dst[c] * factor(get(state, "dst_factor"), c, src, dst, constant);
        out[c] = is(operation, "add") ? s + d
               : is(operation, "subtract") ? s - d
               : is(operation, "reverse-subtract") ? d - s
               : is(operation, "min") ? fmin(src[c], dst[c]) : fmax(src[c], dst[c]);
    }
    memcpy(src, out, sizeof out);
}

static int compare(const char *name, float a, float b) {
    if (is(name, "never")) return 0;
    if (is(name, "less")) return a < b;
    if (is(name, "equal")) return a == b;
    if (is(name, "less-equal")) return a <= b;
    if (is(name, "greater")) return a > b;
    if (is(name, "not-equal")) return a != b;
    if (is(name, "greater-equal")) return a >= b;
    return 1;
}

/* A draw. */

typedef struct {
    float position[4], color[4], uv[2];
} Vertex;

typedef struct {
    const char *depth, *blend, *cull;
    Image *color_image, *depth_image;
    double viewport[4], range[2], scissor[4], params[4], constant[4];
    int ccw, mask, write_mask, to_coverage, from_vertex, writes_depth;
    uint64_t passed;
} Draw;

static int64_t edge(const int64_t *a, const int64_t *b, int64_t x, int64_t y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

/* Returns whether a point is inside an edge: top and left edges have the points on them. */
static int inside(const int64_t *a, const int64_t *b, int64_t value) {
    int64_t dx = b[0] - a[0], dy = b[1] - a[1];
    return value > 0 || (value == 0 && (dy < 0 || (dy == 0 && dx > 0)));
}

static void sample(Draw *d, size_t texel, int s, double z, const float *vertex) {
    Image *any = d->color_image ? d->color_image : d->depth_image;
    size_t place = 4 * (texel * (size_t)any->samples + (size_t)s);
    float depth = (float)(d->range[0] + z * (d->range[1] - d->range[0])), stored = 0;
    double src[4], dst[4];
    if (d->writes_depth) depth = vertex[0];
    if (d->depth_image && d->depth) {
        memcpy(&stored, d->depth_image->bytes + place, 4);
        if (!compare(get(d->depth, "compare"), depth, stored)) return;
        if (*get(d->depth, "write") == 't') memcpy(d->depth_image->bytes + place, &depth, 4);
    }
    d->passed++;
    if (!d->color_image) return;
    for (int c = 0; c < 4; c++) src[c] = clamped(d->from_vertex ? vertex[c] : d->params[c]);
    load(d->color_image, d->color_image->bytes + place, dst);
    if (d->blend) blended(d->blend, src, dst, d->constant);
    store(d->color_image, d->color_image->bytes + place, src, d->write_mask);
}

static void triangle(Draw *d, const Vertex *v0, const Vertex *v1, const Vertex *v2) {
    Image *any = d->color_image ? d->color_image : d->depth_image;
    const Vertex *v[3] = {v0, v1, v2};
    int64_t p[3][2];
    double z[3];
    for (int i = 0; i < 3; i++) {
        double w = v[i]->position[3], x = v[i]->position[0] / w, y = v[i]->position[1] / w;
        if (upside_down) y = -y;
        p[i][0] = llround((d->viewport[0] + (1 + x) / 2 * d->viewport[2]) * 256);
        p[i][1] = llround((d->viewport[1] + (1 - y) / 2 * d->viewport[3]) * 256);
        z[i] = v[i]->position[2] / w;
    }
    int64_t area = edge(p[0], p[1], p[2][0], p[2][1]);
    /* y points down here, so a positive area is clockwise. */
    int front = (area < 0) == d->ccw;
    if (area == 0 || is(d->cull, front ? "front" : "back")) return;
    int b = area > 0 ? 1 : 2, c = 3 - b, low[2], high[2];
    for (int axis = 0; axis < 2; axis++) {
        double least = fmin(p[0][axis], fmin(p[1][axis], p[2][axis])) / 256;
        double most = fmax(p[0][axis], fmax(p[1][axis], p[2][axis])) / 256 + 1;
        /* Clipping at the sides of the view volume: viewports have whole texels here. */
        low[axis] = (int)fmax(fmax(least, d->viewport[axis]), fmax(0, d->scissor[axis]));
        high[axis] = (int)fmin(fmin(most, d->viewport[axis] + d->viewport[axis + 2]),
                               fmin(axis ? any->height : any->width, d->scissor[axis] + d->scissor[axis + 2]));
    }
    for (int y = low[1]; y < high[1]; y++) {
        for (int x = low[0]; x < high[0]; x++) {
            for (int s = 0; s < any->samples; s++) {
                int centre = any->samples == 1 || one_sample;
                int64_t px = x * 256 + (centre ? 128 : POSITIONS[s][0]), py = y * 256 + (centre ? 128 : POSITIONS[s][1]);
                int64_t ea = edge(p[b], p[c], px, py), eb = edge(p[c], p[0], px, py), ec = edge(p[0], p[b], px, py);
                if (!inside(p[b], p[c], ea) || !inside(p[c], p[0], eb) || !inside(p[0], p[b], ec)) continue;
                double whole = (double)(ea + eb + ec);
                double depth = z[0] + ((double)eb * (z[b] - z[0]) + (double)ec * (z[c] - z[0])) / whole;
                int kept = d->mask;
                if (d->to_coverage) {
                    double alpha = clamped(d->from_vertex ? v0->color[3] : d->params[3]);
                    kept &= (1 << (int)(alpha * any->samples + 0.5)) - 1;
                }
                if (one_sample) kept |= kept ? -1 : 0;
                if (depth < 0 || depth > 1 || !(kept >> s & 1)) continue;
                sample(d, (size_t)y * (size_t)any->width + (size_t)x, s, depth, v0->color);
            }
        }
    }
}

/* Draws; returns what is missing, or 0. */
static const char *draw(const char *json, Image *color, Image *depth, uint64_t *counters) {
    Image *any = color ? color : depth;
    Draw d = {.color_image = color, .depth_image = depth, .write_mask = 15};
    const char *bias = get(json, "depth_bias"), *shader = get(json, "shader"), *topology = get(json, "topology");
    const char *viewport = get(json, "viewport"), *scissor = get(json, "scissor"), *target, *text, *index;
    int strip = is(topology, "triangle-strip");
    d.from_vertex = is(shader, "flat_color");
    d.writes_depth = is(shader, "flat_color_depth");
    if (!d.from_vertex && !d.writes_depth && !is(shader, "uniform_color")) return "this shader";
    if (!strip && !is(topology, "triangle-list")) return "points and lines";
    if (number(get(bias, "constant")) || number(get(bias, "slope"))) return "depth bias";
    d.depth = get(json, "depth");
    d.cull = get(json, "cull");
    d.ccw = is(get(json, "front_face"), "ccw");
    numbers(get(viewport, "rect"), 4, d.viewport);
    numbers(get(viewport, "depth"), 2, d.range);
    numbers(get(get(json, "params"), "color"), 4, d.params);
    numbers(get(json, "blend_constant"), 4, d.constant);
    for (int c = 0; c < 4; c++) d.constant[c] = clamped(d.constant[c]);
    d.scissor[2] = any->width, d.scissor[3] = any->height;
    if (scissor) numbers(scissor, 4, d.scissor);
    d.mask = (int)(uint32_t)number(get(get(json, "multisample"), "mask"));
    d.to_coverage = any->samples > 1 && *get(get(json, "multisample"), "alpha_to_coverage") == 't';
    if ((target = item(get(json, "targets"), 0))) {
        d.blend = get(target, "blend");
        d.write_mask = (int)number(get(target, "write_mask"));
    }
    text = get(json, "vertices");
    Vertex *vertices = malloc((size_t)(after(text) - text) + sizeof *vertices);
    size_t vertex_count = decode(text, (uint8_t *)vertices) / sizeof *vertices, count = 0, run = 0;
    index = get(json, "indices");
    size_t *order = malloc(((index ? (size_t)(after(index) - index) : vertex_count) + 1) * sizeof *order);
    if (index) {
        for (const char *p = first(index); p; p = next(p)) order[count++] = (size_t)number(p);
    } else {
        for (; count < vertex_count; count++) order[count] = count;
    }
    const char *missing = 0;
    for (size_t i = 0; i < vertex_count; i++) {
        float *p = vertices[i].position;
        if (!(p[3] > 0) || fabsf(p[0] / p[3]) > 1e4f || fabsf(p[1] / p[3]) > 1e4f) missing = "vertices behind the eye";
    }
    for (size_t i = 0; !missing && i < count; i++) {
        run = order[i] == UINT32_MAX ? 0 : run + 1;
        if (run < 3 || (!strip && run % 3)) continue;
        const Vertex *a = vertices + order[i - 2], *b = vertices + order[i - 1], *c = vertices + order[i];
        /* Every second triangle of a strip has its last two vertices exchanged, so that the first one provokes. */
        if (strip && run % 2 == 0) triangle(&d, a, c, b);
        else triangle(&d, a, b, c);
    }
    for (index = first(get(json, "counters")); index; index = next(index)) counters[(int)number(index)] += d.passed;
    free(vertices);
    free(order);
    return missing;
}

static void operation(Image *image, const char *load) {
    double color[4];
    const char *value = *load == '{' ? get(load, "clear") : 0;
    if (!value) return;
    if (image->is_depth) color[0] = number(value);
    else numbers(value, 4, color);
    clear(image, color);
}

static void resolve(const Image *from, Image *to) {
    for (size_t i = 0; i < samples_of(to); i++) {
        double sum[4] = {0}, color[4];
        for (int s = 0; s < from->samples; s++) {
            load(from, from->bytes + 4 * (i * (size_t)from->samples + (size_t)s), color);
            for (int c = 0; c < 4; c++) sum[c] += color[c] / from->samples;
        }
        store(to, to->bytes + 4 * i, sum, 15);
    }
}

static const char *pass(const char *json, Image *images, uint64_t *counters) {
    const char *color = item(get(json, "color"), 0), *depth = get(json, "depth_stencil"), *draws = get(json, "draws");
    Image *color_image = color ? images + (int)number(get(color, "attachment")) : 0;
    Image *depth_image = depth ? images + (int)number(get(depth, "attachment")) : 0;
    const char *one, *missing = 0;
    if (color) operation(color_image, get(color, "load"));
    if (depth) operation(depth_image, get(get(depth, "depth"), "load"));
    for (one = first(draws); one && !missing; one = next(one)) missing = draw(one, color_image, depth_image, counters);
    if (color && get(color, "resolve")) resolve(color_image, images + (int)number(get(color, "resolve")));
    return missing;
}

static void answer(const char *line) {
    const char *scene = get(line, "scene"), *all = get(scene, "attachments"), *one, *missing = 0, *kind;
    Image images[64] = {0};
    uint64_t counters[64] = {0}, *count_of;
    int count = 0;
    for (one = first(all); one && count < 64; one = next(one)) {
        Image *image = images + count++;
        double color[4] = {0}, size[2];
        numbers(get(one, "size"), 2, size);
        image->width = (int)size[0], image->height = (int)size[1];
        image->samples = (int)number(get(one, "samples"));
        image->is_depth = is(get(one, "format"), "depth32float");
        image->is_srgb = is(get(one, "format"), "rgba8unorm-srgb");
        image->bytes = malloc(4 * samples_of(image) + 4);
        if (get(one, "texels")) {
            decode(get(one, "texels"), image->bytes);
            continue;
        }
        if (image->is_depth) color[0] = number(get(one, "depth"));
        else numbers(get(one, "clear"), 4, color);
        clear(image, color);
    }
    for (one = first(get(scene, "passes")); one && !missing; one = next(one)) missing = pass(one, images, counters);
    printf("{\"number\":%.0f,", number(get(line, "number")));
    if (missing) {
        printf("\"unsupported\":\"%s\"}\n", missing);
    } else {
        printf("\"frame\":{\"images\":[");
        for (one = first(get(scene, "read")); one; one = next(one)) {
            Image *image = images + (int)number(one);
            const char *name = get(item(all, (int)number(one)), "name");
            printf("{\"attachment\":%.*s,", (int)strcspn(name + 1, "\"") + 2, name);
            printf("\"aspect\":\"%s\",\"texels\":\"", image->is_depth ? "depth" : "color");
            encode(image->bytes, 4 * samples_of(image));
            printf(next(one) ? "\"}," : "\"}");
        }
        printf("],\"counters\":[");
        count_of = counters;
        for (kind = first(get(scene, "counters")); kind; kind = next(kind), count_of++) {
            uint64_t value = is(kind, "any-samples-passed") ? *count_of > 0 : *count_of;
            printf(next(kind) ? "%llu," : "%llu", (unsigned long long)value);
        }
        printf("]}}\n");
    }
    fflush(stdout);
    while (count) free(images[--count].bytes);
}

int main(int argc, char **argv) {
    char *line = 0;
    size_t size = 0;
    for (int i = 1; i < argc; i++) {
        upside_down |= !strcmp(argv[i], "upside-down");
        srgb_twice |= !strcmp(argv[i], "srgb-twice");
        one_sample |= !strcmp(argv[i], "one-sample");
    }
    puts(HELLO);
    fflush(stdout);
    while (getline(&line, &size, stdin) > 0) answer(line);
    return 0;
}
