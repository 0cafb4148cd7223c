/* SPDX-License-Identifier: MIT
 * Pictures of triangles: what covers what, no gaps along shared edges, clipping at the eye, edges,
 * and the same bytes for any number of threads.
 */
#include "render_support.h"

/* Two squares that face -y: a small red one at y = -1, a large blue one at y = 1. */
static const float squares[] = {-1, -1, -1, 1, -1, -1, 1, -1, 1, -1, -1, 1,
                                -2, 1,  -2, 2, 1,  -2, 2, 1,  2, -2, 1,  2};
static const uint32_t square_indices[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
static const uint8_t square_colors[] = {255, 0,   0, 255, 255, 0,   0, 255, 255, 0,  0,
                                        255, 255, 0, 0,   255, 0,   0, 255, 255, 0,  0,
                                        255, 255, 0, 0,   255, 255, 0, 0,   255, 255};

static csgm_mesh_view squares_view(void)
{
    return (csgm_mesh_view){.positions = squares,
                            .colors = square_colors,
                            .indices = square_indices,
                            .vertex_count = 8,
                            .triangle_count = 4};
}

/* Of a case's field; of equal cells where there is a resolution. */
static csgm_mesh *mesh_of(const render_case *c, csgm_quality quality, uint32_t resolution)
{
    csgm_mesh *mesh;
    csgm_mesh_options options = csgm_mesh_options_default();
    options.quality = quality;
    options.resolution = resolution;
    assert_int_equal(csgm_mesh_build(c->context, c->field, &options, &mesh, NULL), CSGM_OK);
    return mesh;
}

static void test_front_hides_back(void **state)
{
    render_case c;
    csgm_mesh_view mesh = squares_view();
    render_begin(&c, 2, CSGM_ISA_AUTO, NULL);
    csgm_render_options options = front_options(120, 6);
    render_mesh(&c, &mesh, &options);
    assert_true(pixel_at(&c, 60, 60)[0] > 150 && pixel_at(&c, 60, 60)[2] < 60);
    assert_true(pixel_at(&c, 60, 30)[2] > 150 && pixel_at(&c, 60, 30)[0] < 60);
    assert_int_equal(pixel_at(&c, 60, 5)[3], 0);
    assert_true(fabs(covered(&c) - 80 * 80) < 1);
    options.camera.projection = CSGM_PERSPECTIVE;
    render_mesh(&c, &mesh, &options);
    assert_true(pixel_at(&c, 60, 60)[0] > 150 && pixel_at(&c, 60, 60)[2] < 60);
    /* from behind one sees the inner side of the blue one: reddish, to be noticed */
    options.camera.azimuth_deg = 180;
    render_mesh(&c, &mesh, &options);
    assert_true(pixel_at(&c, 60, 60)[0] > 60);
    render_end(&c);
}

/* Each sample of a square cut into slivers belongs to exactly one of them. */
static void test_no_gaps(void **state)
{
    enum { FAN = 37 };
    float positions[3 * (FAN + 2)];
    uint32_t indices[3 * FAN];
    render_case c;
    positions[0] = -2;
    positions[1] = 0;
    positions[2] = -2;
    for (int i = 0; i <= FAN; i++) {
        float share = (float)i / FAN;
        positions[3 * i + 3] = share < 0.5f ? 2 : 2 - 8 * (share - 0.5f);
        positions[3 * i + 4] = 0;
        positions[3 * i + 5] = share < 0.5f ? -2 + 8 * share : 2;
    }
    for (uint32_t i = 0; i < FAN; i++) {
        indices[3 * i] = 0;
        indices[3 * i + 1] = i + 1;
        indices[3 * i + 2] = i + 2;
    }
    csgm_mesh_view mesh = {
        .positions = positions, .indices = indices, .vertex_count = FAN + 2, .triangle_count = FAN};
    render_begin(&c, 1, CSGM_ISA_AUTO, NULL);
    csgm_render_options options = front_options(150, 6);
    for (uint32_t samples = 1; samples <= 8; samples++) {
        options.samples = samples;
        render_mesh(&c, &mesh, &options);
        for (uint32_t y = 27; y < 123; y++)
            for (uint32_t x = 27; x < 123; x++)
                if (x > 32 && y > 32 && x + y > 60 && pixel_at(&c, x, y)[3] != 255)
                    fail_msg("a gap at %u, %u with %u samples", x, y, samples);
    }
    render_end(&c);
}

static void test_a_scenes_mesh(void **state)
{
    render_case c;
    render_begin(&c, 2, CSGM_ISA_AUTO,
                 "difference() { sphere(r = 1); translate([0.6, -0.6, 0.6]) "
                 "color(\"red\") sphere(r = 0.6); }");
    csgm_mesh *mesh = mesh_of(&c, CSGM_QUALITY_NORMAL, 128);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    csgm_render_options options = front_options(200, 2.4);
    render_scene(&c, &options);
    csgm_image *traced = c.image;
    c.image = NULL;
    render_mesh(&c, &view, &options);
    csgm_image_view a = csgm_image_get_view(traced), b = csgm_image_get_view(c.image);
    double difference = 0;
    for (size_t i = 0; i < (size_t)4 * 200 * 200; i++)
        difference += abs(a.pixels[i] - b.pixels[i]);
    assert_true(difference / (4.0 * 200 * 200) < 0.6); /* of 255, on average */
    csgm_image_destroy(traced);

    csgm_image *first = c.image;
    c.image = NULL;
    render_case three;
    render_begin(&three, 3, CSGM_ISA_SCALAR, NULL);
    render_mesh(&three, &view, &options);
    assert_same_image(first, three.image, "three threads");
    options.wireframe = true;
    render_mesh(&three, &view, &options);
    uint64_t darker = 0;
    a = csgm_image_get_view(first);
    b = csgm_image_get_view(three.image);
    for (size_t i = 0; i < (size_t)200 * 200; i++)
        darker += b.pixels[4 * i + 1] < a.pixels[4 * i + 1];
    assert_true(darker > 5000);
    render_end(&three);
    csgm_image_destroy(first);
    csgm_mesh_destroy(mesh);
    render_end(&c);
}

/* The ground is darkened, the solid stays as it is, and it is not there from below; a mesh throws
 * about the shadow of its scene. */
static void test_ground(void **state)
{
    enum { SIDE = 160 };
    render_case c, three;
    render_begin(&c, 2, CSGM_ISA_AUTO,
                 "translate([0, 0, 0.3]) cube([1.6, 1, 0.2], center = true);\n"
                 "for (x = [-0.6, 0.6]) translate([x, 0, -0.3]) cylinder(r = 0.15, h = 0.6);");
    csgm_mesh *mesh = mesh_of(&c, CSGM_QUALITY_NORMAL, 0);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    csgm_render_options options = front_options(SIDE, 4);
    options.camera.elevation_deg = 35;
    options.occlusion = options.shadows = true;
    options.ground = false;
    render_mesh(&c, &view, &options);
    csgm_image *without = c.image;
    c.image = NULL;
    options.ground = true;
    render_scene(&c, &options);
    csgm_image *traced = c.image;
    c.image = NULL;
    render_mesh(&c, &view, &options);
    csgm_image_view no = csgm_image_get_view(without), with = csgm_image_get_view(c.image);
    csgm_image_view scene = csgm_image_get_view(traced);
    double shadow = 0, difference = 0;
    for (size_t i = 0; i < (size_t)SIDE * SIDE; i++) {
        const uint8_t *p = with.pixels + 4 * i;
        if (no.pixels[4 * i + 3] == 255)
            assert_memory_equal(no.pixels + 4 * i, p, 4);
        if (no.pixels[4 * i + 3] != 0)
            continue;
        assert_true(p[0] + p[1] + p[2] == 0);
        shadow += p[3] / 255.0;
        difference += fabs(p[3] / 255.0 - scene.pixels[4 * i + 3] / 255.0);
    }
    assert_true(shadow > 200 && shadow < 2500);
    assert_true(difference < 0.25 * shadow);
    render_begin(&three, 3, CSGM_ISA_SCALAR, NULL);
    render_mesh(&three, &view, &options);
    assert_same_image(c.image, three.image, "three threads");
    render_end(&three);

    options.camera.elevation_deg = -35;
    csgm_image_destroy(without);
    render_mesh(&c, &view, &options);
    without = c.image;
    c.image = NULL;
    options.ground = false;
    render_mesh(&c, &view, &options);
    assert_same_image(without, c.image, "from below");
    csgm_image_destroy(without);
    csgm_image_destroy(traced);
    csgm_mesh_destroy(mesh);
    render_end(&c);
}

/* How much darker a picture is than another of the same solid, in whole pixels. */
static double darkness(const csgm_image *image, const csgm_image *than)
{
    csgm_image_view a = csgm_image_get_view(image), b = csgm_image_get_view(than);
    double sum = 0;
    for (size_t i = 0; i < (size_t)a.width * a.height; i++)
        if (a.pixels[4 * i + 3] == 255)
            sum += (b.pixels[4 * i + 1] - a.pixels[4 * i + 1]) / 255.0;
    return sum;
}

/* What stands on a plate throws a shadow on it, as in the scene's picture; a ball throws none on
 * itself, nor does the plate alone. */
static void test_own_shadow(void **state)
{
    enum { SIDE = 160 };
    static const struct {
        const char *text;
        double least, most; /* whole pixels, in the light's shadow */
    } solids[] = {{"cube([3, 3, 0.2], center = true);"
                   "translate([0, 0, 0.5]) cube([0.3, 0.3, 1.2], center = true);",
                   25, 60},
                  {"cube([3, 3, 0.2], center = true);", -1, 1},
                  {"sphere(r = 1.5);", -1, 3}};
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        render_case c, three;
        double found[2];
        render_begin(&c, 2, CSGM_ISA_AUTO, solids[i].text);
        render_begin(&three, 3, CSGM_ISA_SCALAR, NULL);
        csgm_mesh *mesh = mesh_of(&c, CSGM_QUALITY_FINE, 0);
        csgm_mesh_view view = csgm_mesh_get_view(mesh);
        csgm_render_options options = front_options(SIDE, 5);
        options.camera.elevation_deg = 35;
        options.ground = false;
        for (int of_mesh = 0; of_mesh < 2; of_mesh++) {
            options.shadows = false;
            of_mesh ? render_mesh(&c, &view, &options) : render_scene(&c, &options);
            csgm_image *without = c.image;
            c.image = NULL;
            options.shadows = true;
            of_mesh ? render_mesh(&c, &view, &options) : render_scene(&c, &options);
            found[of_mesh] = darkness(c.image, without);
            csgm_image_destroy(without);
        }
        render_mesh(&three, &view, &options);
        assert_same_image(c.image, three.image, "three threads");
        /* the light's width makes a shadow narrower there, and wider in the scene */
        assert_true(found[1] >= 0.4 * found[0] - 2 && found[1] <= found[0] + 2);
        assert_true(found[1] >= solids[i].least && found[1] <= solids[i].most);
        csgm_mesh_destroy(mesh);
        render_end(&three);
        render_end(&c);
    }
}

/* How much of a picture's light another lacks, in whole pixels. */
static double lines(const csgm_image *image, const csgm_image *than)
{
    csgm_image_view a = csgm_image_get_view(image), b = csgm_image_get_view(than);
    double sum = 0;
    for (size_t i = 0; i < (size_t)a.width * a.height; i++)
        sum += 1 - pow((double)a.pixels[4 * i + 1] / b.pixels[4 * i + 1], 2.2);
    return sum;
}

/* Nine edges of a cube are lines of its picture, and none besides; a ball has its outline alone. As
 * scenes and as meshes, and as long as they should be. */
static void test_edges(void **state)
{
    enum { SIDE = 200 };
    static const struct {
        const char *text;
        double
            length; /* of lines, in the scene's units, as seen from the front and 30 degrees up */
    } solids[] = {{"rotate(45) cube(2, center = true);", 14.68},
                  {"sphere(r = 1.5);", 9.42},
                  {"difference() { cylinder(r = 1.5, h = 1); "
                   "cylinder(r = 0.7, h = 3, center = true); }",
                   16.02}};
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        render_case c, three;
        csgm_image *plain[2];
        render_begin(&c, 1, CSGM_ISA_AUTO, solids[i].text);
        render_begin(&three, 3, CSGM_ISA_SCALAR, solids[i].text);
        csgm_mesh *mesh = mesh_of(&c, CSGM_QUALITY_FINE, 0);
        csgm_mesh_view view = csgm_mesh_get_view(mesh);
        csgm_render_options options = front_options(SIDE, 5);
        options.camera.elevation_deg = 30;
        memset(options.background, 255, sizeof options.background);
        for (int of_mesh = 0; of_mesh < 2; of_mesh++) {
            options.edges = false;
            of_mesh ? render_mesh(&c, &view, &options) : render_scene(&c, &options);
            plain[of_mesh] = c.image;
            c.image = NULL;
            options.edges = true;
            of_mesh ? render_mesh(&c, &view, &options) : render_scene(&c, &options);
            of_mesh ? render_mesh(&three, &view, &options) : render_scene(&three, &options);
            assert_same_image(c.image, three.image, "three threads");
            double found = lines(c.image, plain[of_mesh]) * 5 / SIDE;
            /* a line's middle is one pixel of 0.85 */
            assert_true(found > 0.85 * solids[i].length && found < 1.07 * solids[i].length);
            csgm_image_destroy(plain[of_mesh]);
        }
        csgm_mesh_destroy(mesh);
        render_end(&three);
        render_end(&c);
    }
}

/* Walls that are seen through hide their alpha each, the inner sides none: before a red ball one of
 * a half, before the background a quarter, where a cube stands before the other both. As a scene
 * and as a mesh, with the same bytes from one thread and three. */
static void test_clear(void **state)
{
    enum { SIDE = 120 };
    static const char text[] =
        "color([0, 0, 1, 0.5]) translate([-1, -1, 0]) cube(1.5, center = true);"
        "color(\"red\") translate([-1, 1, 0]) sphere(r = 0.4);"
        "color([0, 1, 0, 0.25]) translate([1, 0, 0]) cube(1.5, center = true);"
        "color([0, 1, 0, 0.25]) translate([1, 2, 0]) cube(1, center = true);";
    render_case c, three;
    render_begin(&c, 1, CSGM_ISA_AUTO, text);
    render_begin(&three, 3, CSGM_ISA_SCALAR, text);
    csgm_mesh *mesh = mesh_of(&c, CSGM_QUALITY_NORMAL, 0);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    csgm_render_options options = front_options(SIDE, 4);
    for (int of_mesh = 0; of_mesh < 2; of_mesh++) {
        of_mesh ? render_mesh(&c, &view, &options) : render_scene(&c, &options);
        of_mesh ? render_mesh(&three, &view, &options) : render_scene(&three, &options);
        assert_same_image(c.image, three.image, "three threads");
        const uint8_t *ball = pixel_at(&c, 30, 60), *half = pixel_at(&c, 12, 42);
        const uint8_t *both = pixel_at(&c, 90, 60), *quarter = pixel_at(&c, 90, 40);
        assert_int_equal(pixel_at(&c, 60, 60)[3], 0);
        assert_int_equal(half[3], 128);
        assert_int_equal(quarter[3], 64);
        assert_true(abs(both[3] - (int)lround(255 * (1 - 0.75 * 0.75))) <= 1);
        assert_int_equal(ball[3], 255);
        assert_true(ball[0] > 120 && ball[2] > 120 && ball[1] < 80);
    }
    csgm_mesh_destroy(mesh);
    render_end(&three);
    render_end(&c);
}

/* From inside a box one sees its walls everywhere, though most corners lie behind the eye. */
static void test_inside(void **state)
{
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, "cube(2, center = true);");
    csgm_mesh *mesh = mesh_of(&c, CSGM_QUALITY_NORMAL, 3);
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    csgm_render_options options = front_options(64, 4);
    options.camera.projection = CSGM_PERSPECTIVE;
    options.camera.fov_deg = 100;
    options.camera.placed = true;
    options.camera.eye = (csgm_vec3){0.3, -0.2, 0.1};
    options.camera.target = (csgm_vec3){1, 1, 1};
    options.frame = (csgm_box){{-1, -1, -1}, {1, 1, 1}};
    render_mesh(&c, &view, &options);
    assert_true(covered(&c) == 64 * 64);
    csgm_mesh_destroy(mesh);
    render_end(&c);
}

/* What is no number, and indices past the end, are left out. */
static void test_hostile_mesh(void **state)
{
    static const float positions[] = {0,   0, 0, 1,        0, 0, 0,     0, 1,
                                      NAN, 0, 0, INFINITY, 1, 1, 1e30f, 0, 1e30f};
    static const uint32_t indices[] = {0, 1, 2, 0, 1, 3, 0, 4, 2, 0, 1, 99, 1, 1, 1, 0, 5, 2};
    csgm_mesh_view mesh = {
        .positions = positions, .indices = indices, .vertex_count = 6, .triangle_count = 6};
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, NULL);
    csgm_render_options options = front_options(64, 4);
    render_mesh(&c, &mesh, &options);
    assert_true(covered(&c) > 100);
    options.camera.projection = CSGM_PERSPECTIVE;
    render_mesh(&c, &mesh, &options);
    mesh.vertex_count = mesh.triangle_count = 0;
    render_mesh(&c, &mesh, &options);
    assert_true(covered(&c) == 0);
    render_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_front_hides_back),
        cmocka_unit_test(test_no_gaps),
        cmocka_unit_test(test_a_scenes_mesh),
        cmocka_unit_test(test_inside),
        cmocka_unit_test(test_hostile_mesh),
        cmocka_unit_test(test_ground),
        cmocka_unit_test(test_own_shadow),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_clear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
