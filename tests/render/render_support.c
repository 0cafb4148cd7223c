/* SPDX-License-Identifier: MIT
 * See render_support.h.
 */
#include "render_support.h"

static void *alloc(void *user, size_t size_bytes)
{
    render_case *c = user;
    if (__atomic_add_fetch(&c->calls, 1, __ATOMIC_RELAXED) == c->fail_at)
        return NULL;
    __atomic_add_fetch(&c->bytes, (int64_t)size_bytes, __ATOMIC_RELAXED);
    return malloc(size_bytes);
}

static void release(void *user, void *memory, size_t size_bytes)
{
    render_case *c = user;
    __atomic_add_fetch(&c->bytes, -(int64_t)size_bytes, __ATOMIC_RELAXED);
    free(memory);
}

static void on_diag(void *user, const csgm_diag *diag)
{
    render_case *c = user;
    c->errors += diag->severity == CSGM_ERROR;
    c->warnings += diag->severity == CSGM_WARNING;
    c->last_code = diag->code;
}

void render_begin(render_case *c, uint32_t threads, csgm_isa isa, const char *text)
{
    *c = (render_case){.bytes = 0};
    csgm_context_options options = csgm_context_options_default();
    options.allocator = (csgm_allocator){alloc, release, c};
    options.threads = threads;
    options.isa = isa;
    options.on_diag = on_diag;
    options.user = c;
    assert_int_equal(csgm_context_create(&options, &c->context), CSGM_OK);
    if (!text)
        return;
    assert_int_equal(csgm_scene_parse(c->context, text, strlen(text), "test", NULL, &c->scene),
                     CSGM_OK);
    assert_int_equal(csgm_field_compile(c->context, c->scene, &c->field), CSGM_OK);
}

void render_end(render_case *c)
{
    csgm_image_destroy(c->image);
    csgm_field_destroy(c->field);
    csgm_scene_destroy(c->scene);
    csgm_context_destroy(c->context);
    assert_int_equal(c->bytes, 0);
}

csgm_render_options front_options(uint32_t pixels, double side)
{
    csgm_render_options options = csgm_render_options_default();
    options.width = options.height = pixels;
    options.camera.projection = CSGM_ORTHOGRAPHIC;
    options.camera.azimuth_deg = options.camera.elevation_deg = 0;
    options.camera.height = side;
    options.frame = (csgm_box){{-side / 2, -side / 2, -side / 2}, {side / 2, side / 2, side / 2}};
    memset(options.background, 0, sizeof options.background);
    options.occlusion = options.shadows = false;
    return options;
}

void render_scene(render_case *c, const csgm_render_options *options)
{
    csgm_image_destroy(c->image);
    c->image = NULL;
    assert_int_equal(csgm_render_scene(c->context, c->field, options, &c->image, &c->stats),
                     CSGM_OK);
    assert_non_null(c->image);
}

void render_mesh(render_case *c, const csgm_mesh_view *mesh, const csgm_render_options *options)
{
    csgm_image_destroy(c->image);
    c->image = NULL;
    assert_int_equal(csgm_render_mesh(c->context, mesh, options, &c->image, &c->stats), CSGM_OK);
    assert_non_null(c->image);
}

const uint8_t *pixel_at(const render_case *c, uint32_t x, uint32_t y)
{
    csgm_image_view view = csgm_image_get_view(c->image);
    assert_true(x < view.width && y < view.height);
    return view.pixels + 4 * ((size_t)y * view.width + x);
}

double covered(const render_case *c)
{
    csgm_image_view view = csgm_image_get_view(c->image);
    double sum = 0;
    for (size_t i = 0; i < (size_t)view.width * view.height; i++)
        sum += view.pixels[4 * i + 3] / 255.0;
    return sum;
}

void assert_same_image(const csgm_image *a, const csgm_image *b, const char *what)
{
    csgm_image_view va = csgm_image_get_view(a), vb = csgm_image_get_view(b);
    assert_true(va.width == vb.width && va.height == vb.height);
    size_t bytes = (size_t)va.width * va.height * 4;
    for (size_t i = 0; i < bytes; i++)
        if (va.pixels[i] != vb.pixels[i])
            fail_msg("%s: pixel %zu, %zu differs: %d and %d", what, i / 4 % va.width,
                     i / 4 / va.width, va.pixels[i], vb.pixels[i]);
}
