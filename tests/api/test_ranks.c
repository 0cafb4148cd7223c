/* SPDX-License-Identifier: MIT
 * One mesh by several ranks, which are threads here, each with a context of its own: the bytes of
 * one process, one status for all, whatever fails on whichever rank.
 */
#include <dirent.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "csgmesh/ranks.h"
#include "failing.h"

enum { RANKS = 3, NEVER = 1 << 30 };

static const char solid_text[] = "difference() {\n"
                                 "  cube(2, center = true);\n"
                                 "  translate([1, 1, 1]) color(\"red\") sphere(r = 1.1);\n"
                                 "}\n";
/* Where the tape is short there is surface in every cube, where it is long in few: the frontier is
 * shared out twice. */
static const char uneven_text[] =
    "sphere(r = 1);\n"
    "translate([4, 0, 0]) intersection() { sphere(r = 1.5);\n"
    "  union(blend = 0.2) for (i = [0 : 30]) rotate([i * 20, i * 37, i * 11])\n"
    "    translate([1.4, 0, 0]) sphere(r = 0.05); }\n";
static const char parts_text[] =
    "part(\"a\") cube(1);\n"
    "part(\"b\") translate([2, 0, 0]) sphere(r = 0.7);\n"
    "part(\"none\") intersection() { cube(1); translate([3, 0, 0]) cube(1); }\n";

/* What is asked of a mesh, beyond what all take. */
typedef enum asked { EQUAL_CELLS, CELLS_THAT_FOLLOW, WITHIN, EQUAL_WITHIN, BETTER } asked;

static csgm_mesh_options options_for(asked of)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    if (of == EQUAL_CELLS || of == EQUAL_WITHIN)
        options.resolution = of == EQUAL_CELLS ? 40 : 24;
    else
        options.quality = CSGM_QUALITY_DRAFT;
    options.tolerance = of == WITHIN || of == EQUAL_WITHIN ? 0.04 : 0;
    options.improve = of == BETTER;
    return options;
}

/* ---- ranks that are threads --------------------------------------------------------------------
 */

/* What they exchange with. Everybody must come to the same exchange. */
typedef struct table {
    pthread_mutex_t mutex;
    pthread_cond_t all_here;
    int here, round, exchanges;
    int breaks_at; /* the exchange that fails on all */
    bool is_lost;  /* somebody did not come, or came for something else */
    const void *own[RANKS];
    uint32_t to[RANKS];
    uint64_t bytes[RANKS][RANKS];
} table;

typedef struct rank {
    table *table;
    uint32_t index;
    const char *text, *path;
    const char *folder; /* csgm_context_keep; NULL: nothing is kept */
    asked of;
    bool differs; /* rank 1 is asked for something else */
    failing memory;
    csgm_status status;
    int errors;
    uint64_t triangles;
    csgm_rank_work work;
} rank;

/* All meet. False: somebody did not come in time. */
static bool meet(table *t)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += 60;
    pthread_mutex_lock(&t->mutex);
    int round = t->round;
    if (++t->here == RANKS) {
        t->here = 0;
        t->round++;
        pthread_cond_broadcast(&t->all_here);
    }
    while (round == t->round && !t->is_lost)
        t->is_lost |= pthread_cond_timedwait(&t->all_here, &t->mutex, &until) != 0;
    bool met = !t->is_lost;
    pthread_mutex_unlock(&t->mutex);
    return met;
}

static bool gather(void *user, uint32_t to, const void *own, const uint64_t *bytes, void *all)
{
    rank *r = user;
    table *t = r->table;
    t->own[r->index] = own;
    t->to[r->index] = to;
    memcpy(t->bytes[r->index], bytes, sizeof t->bytes[0]);
    if (!meet(t))
        return false;
    if (t->to[0] != to || memcmp(t->bytes[0], bytes, sizeof t->bytes[0]) != 0)
        t->is_lost = true;
    uint8_t *at = all;
    for (int i = 0; i < RANKS && all && !t->is_lost; i++) {
        if (bytes[i])
            memcpy(at, t->own[i], bytes[i]);
        at += bytes[i];
    }
    bool breaks = t->exchanges == t->breaks_at;
    if (!meet(t))
        return false;
    if (r->index == 0)
        t->exchanges++;
    return meet(t) && !breaks;
}

static void count_error(void *user, const csgm_diag *diag)
{
    rank *r = user;
    r->errors += diag->severity == CSGM_ERROR;
}

static csgm_status mesh_together(rank *r, csgm_context *context, const csgm_field *field)
{
    csgm_communicator by = csgm_communicator_default();
    by.rank = r->index;
    by.count = RANKS;
    by.gather = gather;
    by.user = r;
    csgm_mesh_options options = options_for(r->of);
    csgm_write_options write_options = csgm_write_options_default();
    options.simplify_error = r->differs && r->index == 1 ? 0.01 : 0;
    write_options.sync = false;
    long left = r->memory.left;
    r->memory.left = NEVER; /* joining is each one's own */
    if (csgm_context_join(context, &by) != CSGM_OK)
        return CSGM_ERR_INTERNAL;
    if (csgm_context_keep(context, r->folder) != CSGM_OK)
        return CSGM_ERR_INTERNAL;
    r->memory.left = left;
    csgm_status status;
    if (r->path) {
        uint64_t counts[2] = {0};
        status = csgm_mesh_build_file(context, field, &options, r->path, CSGM_FORMAT_AUTO,
                                      &write_options, counts, NULL);
        r->triangles = counts[1];
    } else {
        csgm_mesh *mesh = NULL;
        status = csgm_mesh_build(context, field, &options, &mesh, NULL);
        r->triangles = status == CSGM_OK ? csgm_mesh_get_view(mesh).triangle_count : 0;
        csgm_mesh_destroy(mesh);
    }
    r->work = csgm_rank_work_default();
    csgm_context_rank_work(context, &r->work);
    return status;
}

static void *live(void *user)
{
    rank *r = user;
    csgm_context_options options = csgm_context_options_default();
    long left = r->memory.left;
    r->memory.left = NEVER;
    options.threads = 1 + r->index % 2;
    options.allocator =
        (csgm_allocator){.alloc = failing_alloc, .release = failing_release, .user = &r->memory};
    options.on_diag = count_error;
    options.user = r;
    csgm_context *context = NULL;
    csgm_scene *scene = NULL;
    csgm_field *field = NULL;
    r->status = csgm_context_create(&options, &context);
    if (r->status == CSGM_OK)
        r->status = csgm_scene_parse(context, r->text, strlen(r->text), "test", NULL, &scene);
    if (r->status == CSGM_OK)
        r->status = csgm_field_compile(context, scene, &field);
    r->memory.left = left;
    if (r->status == CSGM_OK)
        r->status = mesh_together(r, context, field);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
    return NULL;
}

/* Rank `weak` has so many allocations left. */
static void mesh_by_all(rank ranks[RANKS], const rank *like, uint32_t weak, long left,
                        int breaks_at)
{
    table t = {.breaks_at = breaks_at};
    pthread_t threads[RANKS];
    pthread_mutex_init(&t.mutex, NULL);
    pthread_cond_init(&t.all_here, NULL);
    for (uint32_t i = 0; i < RANKS; i++) {
        ranks[i] = *like;
        ranks[i].table = &t;
        ranks[i].index = i;
        ranks[i].memory.left = i == weak ? left : NEVER;
        assert_int_equal(pthread_create(&threads[i], NULL, live, &ranks[i]), 0);
    }
    for (uint32_t i = 0; i < RANKS; i++)
        pthread_join(threads[i], NULL);
    pthread_cond_destroy(&t.all_here);
    pthread_mutex_destroy(&t.mutex);
    assert_false(t.is_lost);
    for (uint32_t i = 0; i < RANKS; i++) {
        assert_int_equal(ranks[i].memory.live, 0);
        assert_int_equal(ranks[i].status, ranks[0].status);
    }
}

/* ---- files -------------------------------------------------------------------------------------
 */

static char *read_all(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *length = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*length + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *length, file), *length);
    fclose(file);
    return bytes;
}

static void alone(const char *text, const char *path, asked of)
{
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh_options options = options_for(of);
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "test", NULL, &scene), CSGM_OK);
    assert_int_equal(csgm_field_compile(context, scene, &field), CSGM_OK);
    assert_int_equal(
        csgm_mesh_build_file(context, field, &options, path, CSGM_FORMAT_AUTO, NULL, NULL, NULL),
        CSGM_OK);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

/* The folder that the test stands in has nothing in it but this; NULL: nothing. */
static void assert_only(const char *name)
{
    DIR *folder = opendir(".");
    const struct dirent *entry;
    assert_non_null(folder);
    while ((entry = readdir(folder)))
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            assert_non_null(name);
            assert_string_equal(entry->d_name, name);
        }
    closedir(folder);
}

static void test_same_bytes(void **state)
{
    static const struct {
        const char *text, *extension;
    } cases[] = {{solid_text, "ply"}, {solid_text, "stl"}, {solid_text, "glb"},
                 {solid_text, "obj"}, {parts_text, "ply"}, {parts_text, "glb"}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char one[16], many[16];
        size_t lengths[2];
        rank ranks[RANKS];
        snprintf(one, sizeof one, "one.%s", cases[i].extension);
        snprintf(many, sizeof many, "many.%s", cases[i].extension);
        alone(cases[i].text, one, EQUAL_CELLS);
        const rank like = {.text = cases[i].text, .path = many};
        mesh_by_all(ranks, &like, 0, NEVER, -1);
        assert_int_equal(ranks[0].status, CSGM_OK);
        assert_true(ranks[1].work.triangles > 0);
        assert_true(ranks[0].work.halo_cubes > 0);
        char *a = read_all(one, &lengths[0]), *b = read_all(many, &lengths[1]);
        assert_int_equal(lengths[0], lengths[1]);
        assert_memory_equal(a, b, lengths[0]);
        free(a);
        free(b);
        unlink(one);
        unlink(many);
    }
}

static void test_mesh_on_the_first(void **state)
{
    rank ranks[RANKS];
    const rank like = {.text = solid_text};
    (void)state;
    mesh_by_all(ranks, &like, 0, NEVER, -1);
    assert_int_equal(ranks[0].status, CSGM_OK);
    assert_true(ranks[0].triangles > 1000);
    assert_int_equal(ranks[0].triangles,
                     ranks[0].work.triangles + ranks[1].work.triangles + ranks[2].work.triangles);
    assert_int_equal(ranks[1].triangles + ranks[2].triangles, 0);
}

static void assert_same_files(const char *one, const char *other)
{
    size_t lengths[2];
    char *a = read_all(one, &lengths[0]), *b = read_all(other, &lengths[1]);
    assert_int_equal(lengths[0], lengths[1]);
    assert_memory_equal(a, b, lengths[0]);
    free(a);
    free(b);
}

/* Cells that follow the shape, and meshes that are changed after they are made. */
static void test_same_bytes_reshaped(void **state)
{
    static const struct {
        const char *text, *extension;
        asked of;
    } cases[] = {{solid_text, "ply", CELLS_THAT_FOLLOW}, {solid_text, "glb", WITHIN},
                 {solid_text, "ply", EQUAL_WITHIN},      {solid_text, "obj", BETTER},
                 {parts_text, "glb", CELLS_THAT_FOLLOW}, {uneven_text, "stl", CELLS_THAT_FOLLOW}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char one[16], many[16];
        rank ranks[RANKS];
        snprintf(one, sizeof one, "one.%s", cases[i].extension);
        snprintf(many, sizeof many, "many.%s", cases[i].extension);
        alone(cases[i].text, one, cases[i].of);
        const rank like = {.text = cases[i].text, .path = many, .of = cases[i].of};
        mesh_by_all(ranks, &like, 0, NEVER, -1);
        assert_int_equal(ranks[0].status, CSGM_OK);
        for (int k = 0; k < RANKS; k++)
            assert_true(ranks[k].work.tasks > 0);
        assert_same_files(one, many);
        unlink(one);
        unlink(many);
    }
}

/* Whose options are other is told once, by the first, before anything is made. */
static void test_other_options(void **state)
{
    rank ranks[RANKS];
    const rank like = {
        .text = solid_text, .path = "a.ply", .of = CELLS_THAT_FOLLOW, .differs = true};
    (void)state;
    mesh_by_all(ranks, &like, 0, NEVER, -1);
    assert_int_equal(ranks[0].status, CSGM_ERR_ARGUMENT);
    assert_int_equal(ranks[0].errors, 1);
    assert_int_equal(ranks[1].errors + ranks[2].errors, 0);
    assert_only(NULL);
}

static void test_broken_contracts(void **state)
{
    csgm_context *context;
    csgm_communicator by = csgm_communicator_default();
    csgm_rank_work work = csgm_rank_work_default();
    (void)state;
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_context_join(NULL, &by), CSGM_ERR_ARGUMENT);
    by.count = 2;
    assert_int_equal(csgm_context_join(context, &by), CSGM_ERR_ARGUMENT); /* no gather */
    by.gather = gather;
    by.rank = 2;
    assert_int_equal(csgm_context_join(context, &by), CSGM_ERR_ARGUMENT);
    by.rank = 1;
    by.count = CSGM_RANKS_MOST + 1;
    assert_int_equal(csgm_context_join(context, &by), CSGM_ERR_ARGUMENT);
    by.count = 2;
    assert_int_equal(csgm_context_keep(context, "kept"), CSGM_ERR_ARGUMENT); /* it is alone */
    assert_int_equal(csgm_context_join(context, &by), CSGM_OK);
    assert_int_equal(csgm_context_keep(context, ""), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_context_keep(context, "kept"), CSGM_OK);
    assert_int_equal(csgm_context_join(context, NULL), CSGM_OK); /* alone again */
    assert_int_equal(csgm_context_rank_work(context, &work), CSGM_OK);
    assert_int_equal(csgm_context_rank_work(context, NULL), CSGM_ERR_ARGUMENT);
    csgm_context_destroy(context);
}

/* The n-th allocation of one rank fails: all end, alike, and nothing is left. */
static void test_failing_allocations(void **state)
{
    static const struct {
        const char *text, *path;
        asked of;
    } cases[] = {{solid_text, "a.glb", EQUAL_CELLS},
                 {parts_text, "a.ply", EQUAL_CELLS},
                 {solid_text, NULL, EQUAL_CELLS},
                 {solid_text, "a.glb", WITHIN}};
    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (uint32_t weak = 0; weak < RANKS; weak += 2) {
            const rank like = {.text = cases[c].text, .path = cases[c].path, .of = cases[c].of};
            int failures = 0;
            for (long left = 0;; left += 1 + left / (like.of == EQUAL_CELLS ? 12 : 4)) {
                rank ranks[RANKS];
                mesh_by_all(ranks, &like, weak, left, -1);
                if (ranks[0].status == CSGM_OK)
                    break;
                failures++;
                assert_int_equal(ranks[0].status, CSGM_ERR_MEMORY);
                assert_int_equal(ranks[weak].errors, 1);
                assert_only(NULL);
            }
            assert_true(failures > (like.of == EQUAL_CELLS ? 20 : 12));
            if (cases[c].path)
                unlink(cases[c].path);
        }
}

/* The n-th exchange fails on all ranks. */
static void test_failing_exchanges(void **state)
{
    static const asked each[] = {EQUAL_CELLS, CELLS_THAT_FOLLOW};
    (void)state;
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) {
        rank ranks[RANKS];
        const rank like = {.text = solid_text, .path = "a.ply", .of = each[i]};
        int failures = 0;
        for (int n = 0;; n += 1 + n / 16) {
            mesh_by_all(ranks, &like, 0, NEVER, n);
            if (ranks[0].status == CSGM_OK)
                break;
            failures++;
            assert_int_equal(ranks[0].status, CSGM_ERR_IO);
            assert_int_equal(ranks[0].errors, 1);
        }
        assert_true(failures > 3);
        unlink("a.ply");
    }
}

/* ---- jobs that go on -------------------------------------------------------------------------- */

static void empty_folder(void)
{
    static const char *const names[] = {"kept/mesh", "kept/rank-0", "kept/rank-1", "kept/rank-2"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(names[i]);
}

static uint64_t resumed_of(const rank ranks[RANKS])
{
    uint64_t resumed = 0;
    for (int i = 0; i < RANKS; i++)
        resumed += ranks[i].work.resumed_cubes;
    return resumed;
}

/* Stopped at each exchange in turn, then gone on with: the bytes of one process, and the later the
 * stop, the less is made again. */
static void test_stopped_and_resumed(void **state)
{
    static const struct {
        const char *text, *extension;
    } cases[] = {{solid_text, "ply"}, {solid_text, "glb"}, {uneven_text, "stl"}};
    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char one[16], many[16];
        rank ranks[RANKS];
        uint64_t resumed = 0;
        int stops = 0, names = 0;
        snprintf(one, sizeof one, "one.%s", cases[i].extension);
        snprintf(many, sizeof many, "many.%s", cases[i].extension);
        alone(cases[i].text, one, EQUAL_CELLS);
        const rank like = {.text = cases[i].text, .path = many, .folder = "kept"};
        for (;; stops++) {
            empty_folder();
            mesh_by_all(ranks, &like, 0, NEVER, stops);
            if (ranks[0].status == CSGM_OK)
                break;
            bool is_named = access(many, F_OK) == 0; /* the last exchange tells that it is */
            mesh_by_all(ranks, &like, 0, NEVER, -1);
            assert_int_equal(ranks[0].status, CSGM_OK);
            assert_true(resumed_of(ranks) >= resumed || is_named);
            resumed = is_named ? resumed : resumed_of(ranks);
            names += is_named;
            assert_same_files(one, many);
            unlink(many);
        }
        assert_int_equal(resumed_of(ranks), 0); /* the last was not stopped at all */
        uint64_t cubes = 0;
        for (int k = 0; k < RANKS; k++)
            cubes += ranks[k].work.cubes;
        assert_true(resumed >= cubes && stops > 10 && names <= 1);
        unlink(one);
        unlink(many);
    }
    empty_folder();
    assert_int_equal(rmdir("kept"), 0);
}

/* What another field has left is not taken, and neither is what was damaged. */
static void test_not_resumed(void **state)
{
    rank ranks[RANKS];
    const rank like = {.text = solid_text, .path = "many.ply", .folder = "kept"};
    const rank other = {.text = uneven_text, .path = "many.ply", .folder = "kept"};
    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    alone(solid_text, "one.ply", EQUAL_CELLS);
    mesh_by_all(ranks, &other, 0, NEVER, 14);
    assert_int_equal(ranks[0].status, CSGM_ERR_IO);
    mesh_by_all(ranks, &like, 0, NEVER, -1);
    assert_int_equal(ranks[0].status, CSGM_OK);
    assert_int_equal(resumed_of(ranks), 0);
    assert_same_files("one.ply", "many.ply");
    unlink("many.ply");
    empty_folder();
    mesh_by_all(ranks, &like, 0, NEVER, 14);
    assert_int_equal(truncate("kept/rank-1", 300), 0);
    unlink("kept/mesh");
    mesh_by_all(ranks, &like, 0, NEVER, -1);
    assert_int_equal(ranks[0].status, CSGM_OK);
    assert_int_equal(ranks[1].work.resumed_cubes, 0);
    assert_true(ranks[0].work.resumed_cubes > 0);
    assert_same_files("one.ply", "many.ply");
    unlink("many.ply");
    unlink("one.ply");
    empty_folder();
    assert_int_equal(rmdir("kept"), 0);
}

static void test_cannot_be_kept(void **state)
{
    static const char *const paths[] = {"a.obj", "a.ply", "a.ply"};
    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        rank ranks[RANKS];
        const rank like = {.text = i == 1 ? parts_text : solid_text,
                           .path = paths[i],
                           .folder = "kept",
                           .of = i == 2 ? CELLS_THAT_FOLLOW : EQUAL_CELLS};
        mesh_by_all(ranks, &like, 0, NEVER, -1);
        assert_int_equal(ranks[0].status, CSGM_ERR_UNSUPPORTED);
        assert_int_equal(ranks[0].errors, 1);
        assert_int_equal(ranks[1].errors + ranks[2].errors, 0);
    }
    assert_int_equal(rmdir("kept"), 0);
    rank ranks[RANKS];
    const rank like = {.text = solid_text, .path = "a.ply", .folder = "kept"}; /* not there */
    mesh_by_all(ranks, &like, 0, NEVER, -1);
    assert_int_equal(ranks[0].status, CSGM_ERR_IO);
    assert_only(NULL);
}

/* The n-th allocation of a rank fails, in a job that goes on and in one that begins. */
static void test_failing_allocations_resumed(void **state)
{
    rank ranks[RANKS];
    const rank like = {.text = solid_text, .path = "many.glb", .folder = "kept"};
    int failures = 0;
    (void)state;
    assert_int_equal(mkdir("kept", 0777), 0);
    alone(solid_text, "one.glb", EQUAL_CELLS);
    for (long left = 0;; left += 1 + left / 12) {
        mesh_by_all(ranks, &like, 1, left, -1);
        if (ranks[0].status == CSGM_OK)
            break;
        failures++;
        assert_int_equal(ranks[0].status, CSGM_ERR_MEMORY);
    }
    assert_true(failures > 20);
    assert_same_files("one.glb", "many.glb");
    unlink("one.glb");
    unlink("many.glb");
    empty_folder();
    assert_int_equal(rmdir("kept"), 0);
}

static int go_in(void **state)
{
    static char folder[] = "ranks-XXXXXX";
    *state = mkdtemp(folder);
    return *state ? chdir(folder) : -1;
}

static int come_out(void **state)
{
    return chdir("..") != 0 || rmdir(*state) != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_broken_contracts),
        cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_mesh_on_the_first),
        cmocka_unit_test(test_same_bytes_reshaped),
        cmocka_unit_test(test_other_options),
        cmocka_unit_test(test_failing_allocations),
        cmocka_unit_test(test_failing_exchanges),
        cmocka_unit_test(test_stopped_and_resumed),
        cmocka_unit_test(test_not_resumed),
        cmocka_unit_test(test_cannot_be_kept),
        cmocka_unit_test(test_failing_allocations_resumed),
    };
    return cmocka_run_group_tests(tests, go_in, come_out);
}
