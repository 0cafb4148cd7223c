/* SPDX-License-Identifier: MIT
 * Pictures that do not come about: options out of range, cancelled, out of time, over the memory
 * limit, and with each allocation refused in turn; and their files.
 */
#include "render_support.h"

#include <stdio.h>
#include <unistd.h>

static const char text[] = "union(blend = 0.3) { sphere(r = 1);\n"
                           "  translate([0.8, 0, 0]) #color(\"red\", 0.5) cube(0.9); }\n"
                           "%cube([3, 1, 1]);\n";

enum { BAD_PICTURE = 430, TIMEOUT = 902 };

static void test_options(void **state)
{
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, text);
    for (int i = 0; i < 16; i++) {
        csgm_render_options o = csgm_render_options_default();
        o.width = o.height = 16;
        csgm_render_options *const p = &o;
        switch (i) {
        case 0:
            p->width = 0;
            break;
        case 1:
            p->height = 16385;
            break;
        case 2:
            p->samples = 0;
            break;
        case 3:
            p->samples = 9;
            break;
        case 4:
            p->camera.fov_deg = 0.5;
            break;
        case 5:
            p->camera.fov_deg = NAN;
            break;
        case 6:
            p->camera.elevation_deg = 91;
            break;
        case 7:
            p->camera.zoom = 0;
            break;
        case 8:
            p->camera.placed = true;
            break; /* eye = target */
        case 9:
            p->camera.placed = true;
            p->camera.eye.z = 5; /* up along the line of sight */
            break;
        case 10:
            p->camera.height = -1;
            break;
        case 11:
            p->slice_axis = 3;
            break;
        case 12:
            p->slice_at = INFINITY;
            break;
        case 13:
            p->iso_step = -1;
            break;
        case 14:
            p->frame = (csgm_box){{0, 0, 0}, {1, 1, INFINITY}};
            break;
        default:
            p->camera.azimuth_deg = NAN;
        }
        csgm_image *image = (csgm_image *)1;
        c.errors = 0;
        c.last_code = 0;
        assert_int_equal(csgm_render_scene(c.context, c.field, &o, &image, NULL),
                         CSGM_ERR_ARGUMENT);
        assert_null(image);
        assert_int_equal(c.errors, 1);
        assert_int_equal(c.last_code, BAD_PICTURE);
    }
    csgm_render_options unset = {.width = 10, .height = 10};
    csgm_image *image;
    assert_int_equal(csgm_render_scene(c.context, c.field, &unset, &image, NULL),
                     CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_render_scene(c.context, NULL, NULL, &image, NULL), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_render_mesh(c.context, NULL, NULL, &image, NULL), CSGM_ERR_ARGUMENT);
    render_end(&c);
}

static bool always(void *user)
{
    return true;
}

static void test_cancelled(void **state)
{
    render_case c;
    csgm_image *image;
    render_begin(&c, 2, CSGM_ISA_AUTO, text);
    int64_t before = c.bytes;
    for (int kind = 0; kind < 3; kind++) {
        csgm_render_options options = front_options(64, 4);
        options.monitor.cancelled = always;
        options.camera.elevation_deg = 30; /* the ground, too */
        options.slice_axis = kind == 1 ? 0 : -1;
        options.evaluator = kind == 2 ? CSGM_EVALUATOR_LAZY : CSGM_EVALUATOR_FAST;
        assert_int_equal(csgm_render_scene(c.context, c.field, &options, &image, NULL),
                         CSGM_CANCELLED);
        assert_null(image);
        assert_int_equal(c.bytes, before);
        assert_int_equal(c.errors, 0);
    }
    render_end(&c);
}

static void test_timeout(void **state)
{
    render_case c;
    csgm_image *image;
    render_begin(&c, 1, CSGM_ISA_AUTO, text);
    csgm_context *own = c.context;
    csgm_context_options options = csgm_context_options_default();
    options.limits.timeout_s = 1e-9;
    assert_int_equal(csgm_context_create(&options, &c.context), CSGM_OK);
    assert_int_equal(csgm_render_scene(c.context, c.field, NULL, &image, NULL), CSGM_ERR_LIMIT);
    assert_null(image);
    csgm_context_destroy(c.context);
    c.context = own;
    render_end(&c);
}

static csgm_status draw(render_case *c, int kind, const csgm_mesh_view *mesh, const char *path)
{
    csgm_render_options options = front_options(40, 4);
    options.occlusion = options.shadows = true;
    options.camera.elevation_deg = 30; /* the ground, too */
    options.slice_axis = kind == 1 ? 0 : -1;
    options.evaluator = kind == 2 ? CSGM_EVALUATOR_LAZY : CSGM_EVALUATOR_FAST;
    options.bounds = kind == 4 ? (csgm_box){{0, -1, -1}, {1, 1, 1}} : options.bounds;
    csgm_image *image = NULL;
    csgm_status status = kind == 3
                             ? csgm_render_mesh(c->context, mesh, &options, &image, NULL)
                             : csgm_render_scene(c->context, c->field, &options, &image, NULL);
    assert_true((status == CSGM_OK) == (image != NULL));
    if (status == CSGM_OK)
        status = csgm_image_write(c->context, image, path, CSGM_IMAGE_AUTO);
    csgm_image_destroy(image);
    return status;
}

/* The name of a temporary file that could not be kept is trouble with a file. */
static bool is_refusal(csgm_status status)
{
    return status == CSGM_ERR_MEMORY || status == CSGM_ERR_IO;
}

static void test_any_allocation_may_fail(void **state)
{
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const uint32_t indices[] = {0, 1, 2};
    static const uint8_t colors[] = {9, 9, 9, 99, 9, 9, 9, 99, 9, 9, 9, 99}; /* seen through */
    csgm_mesh_view mesh = {.positions = positions,
                           .colors = colors,
                           .indices = indices,
                           .vertex_count = 3,
                           .triangle_count = 1};
    char path[] = "/tmp/csgmesh-render-XXXXXX.png";
    int fd = mkstemps(path, 4);
    assert_true(fd >= 0);
    close(fd);
    bool png = csgm_image_format_available(CSGM_IMAGE_PNG);
    for (int kind = 0; kind < 5; kind++) {
        csgm_status status = CSGM_ERR_MEMORY;
        int refused = 0;
        for (int64_t n = 1; is_refusal(status) && n < 5000; n++) {
            render_case c; /* a new one: a context shows no more than 20 findings */
            render_begin(&c, 1, CSGM_ISA_AUTO, text);
            int64_t before = c.bytes;
            c.calls = 0;
            c.fail_at = n;
            status = draw(&c, kind, &mesh, path);
            assert_int_equal(c.bytes, before);
            assert_int_equal(c.errors, status == CSGM_OK ? 0 : 1);
            refused += is_refusal(status);
            render_end(&c);
        }
        assert_int_equal(status, png ? CSGM_OK : CSGM_ERR_UNSUPPORTED);
        assert_true(refused > 5);
    }
    unlink(path);
}

static void test_files(void **state)
{
    static const uint8_t pixels[] = {1, 2, 3, 255, 10, 20, 30, 0, 40, 50, 60, 128, 70, 80, 90, 255};
    csgm_image_view view = {2, 2, pixels};
    char path[] = "/tmp/csgmesh-image-XXXXXX.ppm";
    int fd = mkstemps(path, 4);
    assert_true(fd >= 0);
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, NULL);
    assert_int_equal(csgm_image_create(c.context, &view, &c.image), CSGM_OK);
    assert_int_equal(csgm_image_write(c.context, c.image, path, CSGM_IMAGE_AUTO), CSGM_OK);
    FILE *file = fopen(path, "rb");
    char got[64];
    size_t count = fread(got, 1, sizeof got, file);
    fclose(file);
    static const char wanted[] = "P6\n2 2\n255\n\x01\x02\x03\xff\xff\xff\x93\x98\x9d\x46\x50\x5a";
    assert_int_equal(count, sizeof wanted - 1);
    assert_memory_equal(got, wanted, count);
    assert_int_equal(csgm_image_write(c.context, c.image, "/tmp/x.bmp", CSGM_IMAGE_AUTO),
                     CSGM_ERR_UNSUPPORTED);
    assert_int_equal(csgm_image_write(c.context, c.image, "/nowhere/x.ppm", CSGM_IMAGE_AUTO),
                     CSGM_ERR_IO);
    if (csgm_image_format_available(CSGM_IMAGE_PNG)) {
        assert_int_equal(ftruncate(fd, 0), 0);
        assert_int_equal(csgm_image_write(c.context, c.image, path, CSGM_IMAGE_PNG), CSGM_OK);
        file = fopen(path, "rb");
        assert_int_equal(fread(got, 1, 8, file), 8);
        fclose(file);
        assert_memory_equal(got, "\x89PNG\r\n\x1a\n", 8);
    }
    close(fd);
    unlink(path);
    render_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_options), cmocka_unit_test(test_cancelled),
        cmocka_unit_test(test_timeout), cmocka_unit_test(test_any_allocation_may_fail),
        cmocka_unit_test(test_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
