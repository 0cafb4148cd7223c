/* SPDX-License-Identifier: MIT
 * Embedding levels worked out by hand from the rules of UAX #9. Built twice: with FriBidi, and with
 * no_bidi.c in its place (WITHOUT_FRIBIDI), which must refuse what runs in both directions and
 * agree about the rest.
 */
#include <uchar.h>

#include "outline/outline_support.h"

#include "outline/letters/bidi.h"

#define ALEF "\u05D0"
#define BET "\u05D1"
#define ARABIC "\u0628"

static const struct {
    const char32_t *text;
    csg_bidi_base base;
    bool both; /* directions */
    const char *levels;
} cases[] = {
    {U"", CSG_BIDI_BY_TEXT, false, ""},
    {U"ab 12", CSG_BIDI_BY_TEXT, false, "00000"},
    {U"" ALEF BET, CSG_BIDI_BY_TEXT, false, "11"},
    {U"!" ALEF " " BET, CSG_BIDI_BY_TEXT, false, "1111"},
    {U"-", CSG_BIDI_RTL, false, "1"},
    {U"ab", CSG_BIDI_RTL, true, "22"},
    {U"" ALEF "!", CSG_BIDI_LTR, true, "10"},
    {U"ab " ALEF BET " cd", CSG_BIDI_BY_TEXT, true, "00011000"},
    {U"ab " ALEF BET "!", CSG_BIDI_BY_TEXT, true, "000110"},
    {U"" ALEF " cd " BET, CSG_BIDI_BY_TEXT, true, "112211"},
    /* a number in Hebrew keeps its separators (W4), one in Arabic its comma, not its dash (W2) */
    {U"" ALEF BET " 1,234", CSG_BIDI_BY_TEXT, true, "11122222"},
    {U"" ALEF " 1-2", CSG_BIDI_BY_TEXT, true, "11222"},
    {U"" ARABIC " 1,2", CSG_BIDI_BY_TEXT, true, "11222"},
    {U"" ARABIC " 1-2", CSG_BIDI_BY_TEXT, true, "11212"},
    {U"" ALEF " $5", CSG_BIDI_BY_TEXT, true, "1122"},
    /* brackets go with what is around them, as a pair (N0) */
    {U"" ALEF " (cd) " BET, CSG_BIDI_BY_TEXT, true, "11122111"},
    {U"a(" ALEF BET ")c", CSG_BIDI_BY_TEXT, true, "001100"},
    {U"ab (" ALEF BET ") 12", CSG_BIDI_BY_TEXT, true, "0000110022"},
    /* an isolate from right to left with a word that is not */
    {U"a \u2067" ALEF " b\u2069 c", CSG_BIDI_BY_TEXT, true, "000112000"},
};

static void test_levels(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csg_arena arena;
        csg_problem problem = {""};
        int levels[16];
        size_t count = strlen(cases[i].levels);
        csg_arena_init(&arena, &memory);
        csgm_status status = csg_bidi_levels(&arena, (const uint32_t *)cases[i].text, count,
                                             cases[i].base, levels, &problem);
        csg_arena_reset(&arena);
        assert_int_equal(cases[i].text[count], 0);
#ifdef WITHOUT_FRIBIDI
        assert_int_equal(status, cases[i].both ? CSGM_ERR_UNSUPPORTED : CSGM_OK);
        if (cases[i].both) {
            assert_non_null(strstr(problem.text, "FriBidi"));
            continue;
        }
#endif
        assert_int_equal(status, CSGM_OK);
        for (size_t k = 0; k < count; k++)
            if (levels[k] != cases[i].levels[k] - '0')
                fail_msg("text %zu, character %zu has level %d, not %c", i, k, levels[k],
                         cases[i].levels[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_levels, support_setup, support_teardown)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
