/* SPDX-License-Identifier: MIT
 * Lists of features are as long as their polygons, and copies are true and their own.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "mesh/features/features.h"

enum { MANY = 500 };

/* A feature of random lists; its numbers are no true ones. */
static void make_random(csg_random *random, csg_feature_whole *whole)
{
    uint32_t sides = 3 + csg_random_below(random, CSG_FEATURE_MOST_SIDES - 2);
    uint32_t most = sides < CSG_FEATURE_MOST_SHEETS ? sides : CSG_FEATURE_MOST_SHEETS;
    csg_feature_begin(whole,
                      &(csg_feature){.cell = (uint16_t)csg_random_below(random, 512),
                                     .side_count = (uint8_t)sides,
                                     .sheet_count = (uint8_t)(1 + csg_random_below(random, most))});
    csg_feature *f = &whole->feature;
    f->vertex = csg_random_below(random, UINT32_MAX);
    for (int s = 0; s < f->side_count; s++) {
        assert_int_equal(f->side[s].beyond, 0); /* lists begin empty */
        f->side[s] = (csg_feature_side){.corner = {(float)s, 0.5f, -(float)s},
                                        .beyond = csg_random_below(random, 1000),
                                        .edge = (uint8_t)csg_random_below(random, 12)};
        f->triangle[s][2] = (uint8_t)csg_random_below(random, 256);
    }
    for (int k = 0; k < f->sheet_count; k++)
        f->normal[k][1] = (float)csg_random_uniform(random, -1, 1);
}

static void assert_same(const csg_feature *a, const csg_feature *b)
{
    assert_int_equal(a->cell, b->cell);
    assert_int_equal(a->vertex, b->vertex);
    assert_int_equal(a->side_count, b->side_count);
    assert_int_equal(a->sheet_count, b->sheet_count);
    for (int s = 0; s < a->side_count; s++) {
        assert_memory_equal(a->side[s].corner, b->side[s].corner, sizeof a->side[s].corner);
        assert_int_equal(a->side[s].beyond, b->side[s].beyond);
        assert_int_equal(a->side[s].edge, b->side[s].edge);
        assert_memory_equal(a->triangle[s], b->triangle[s], 3);
    }
    for (int k = 0; k < a->sheet_count; k++)
        assert_memory_equal(a->normal[k], b->normal[k], sizeof a->normal[k]);
}

/* What most features need: four sides, two sheets. */
static void test_usual_size(void **state)
{
    csg_feature usual = {.side_count = 4, .sheet_count = 2};
    assert_int_equal(csg_feature_list_bytes(&usual), 4 * 20 + 2 * 12 + 4 * 3);
    assert_true(sizeof usual + csg_feature_list_bytes(&usual) <= 180);
    csg_feature odd = {.side_count = 3, .sheet_count = 1}; /* 3 * 3 bytes of triangles */
    assert_int_equal(csg_feature_list_bytes(&odd), 3 * 20 + 12 + 12);
    csg_feature all = {.side_count = CSG_FEATURE_MOST_SIDES,
                       .sheet_count = CSG_FEATURE_MOST_SHEETS};
    assert_true(csg_feature_list_bytes(&all) <= sizeof((csg_feature_whole *)NULL)->lists);
}

static void test_copies_are_their_own(void **state)
{
    csg_random random = {404};
    for (int i = 0; i < MANY; i++) {
        csg_feature_whole one, kept;
        make_random(&random, &one);
        csg_feature_keep(&kept, &one.feature);
        assert_same(&kept.feature, &one.feature);
        assert_ptr_not_equal(kept.feature.side, one.feature.side);
        int s = one.feature.side_count - 1, k = one.feature.sheet_count - 1;
        one.feature.side[s].beyond++;
        one.feature.triangle[s][2]++;
        one.feature.normal[k][1] += 4;
        one.feature.vertex++;
        assert_int_equal(kept.feature.side[s].beyond + 1, one.feature.side[s].beyond);
        assert_true(kept.feature.normal[k][1] <= 1);
        csg_feature_copy(&one.feature, &kept.feature); /* back, as it was */
        assert_same(&one.feature, &kept.feature);
    }
}

/* One room's features in the store, behind others, and laid out again from bytes as ranks do. */
static void test_into_the_store(void **state)
{
    csg_memory memory;
    csg_memory_init(&memory, NULL, 0);
    csg_feature_store store = {.memory = &memory, .lists = {.memory = &memory}};
    static csg_feature_whole kept[MANY];
    csg_feature_room *room = csg_memory_alloc(&memory, sizeof *room);
    assert_non_null(room);
    csg_feature_room_init(room);
    csg_random random = {175};
    for (int slab = 0; slab < 2; slab++) { /* an empty room can be filled again */
        room->lists.memory = &memory;
        for (int i = slab * MANY / 2; i < (slab + 1) * MANY / 2; i++) {
            csg_feature_whole whole;
            make_random(&random, &whole);
            csg_feature_keep(&kept[i], &whole.feature);
            assert_true(csg_feature_append(&room->features, &room->count, &room->capacity,
                                           &room->lists, &whole.feature));
        }
        assert_true(csg_memory_reserve(&memory, (void **)&room->blocks, &room->block_capacity, 2,
                                       sizeof *room->blocks));
        uint32_t count = (uint32_t)room->count, half = count / 2;
        room->blocks[0] = (csg_feature_block){.first = 0, .count = half};
        room->blocks[1] = (csg_feature_block){.first = half, .count = count - half};
        assert_true(csg_feature_store_add(&store, room, 0, 1));
        assert_true(csg_feature_store_add(&store, room, 1, 1));
        assert_true(csg_feature_store_take_lists(&store, room));
        assert_int_equal(room->count, 0);
    }
    size_t count = store.count;
    assert_int_equal(count, MANY);
    assert_int_equal(store.blocks[2].first, MANY / 2);
    for (size_t i = 0; i < count; i++)
        assert_same(&store.features[i], &kept[i].feature);

    size_t bytes = csg_feature_lists_bytes(store.features, store.count), at = 0;
    uint8_t *packed = csg_memory_alloc(&memory, bytes);
    assert_non_null(packed);
    for (size_t i = 0; i < store.count; i++) {
        memcpy(packed + at, store.features[i].side, csg_feature_list_bytes(&store.features[i]));
        at += csg_feature_list_bytes(&store.features[i]);
    }
    assert_int_equal(at, bytes);
    csg_features_lay_out(store.features, store.count, packed);
    for (size_t i = 0; i < count; i++)
        assert_same(&store.features[i], &kept[i].feature);

    csg_memory_release(&memory, packed, bytes);
    csg_feature_store_release(&store);
    csg_feature_room_release(room);
    csg_memory_release(&memory, room, sizeof *room);
    assert_int_equal(atomic_load(&memory.used_bytes), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_usual_size),
        cmocka_unit_test(test_copies_are_their_own),
        cmocka_unit_test(test_into_the_store),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
