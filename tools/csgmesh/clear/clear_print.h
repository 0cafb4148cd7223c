/* SPDX-License-Identifier: MIT
 * Clearances as JSON, as lines for people and as JUnit XML.
 */
#ifndef CLI_CLEAR_PRINT_H
#define CLI_CLEAR_PRINT_H

#include "clear/clear_over.h"
#include "csgmesh/clearance.h"

typedef struct cli_cleared {
    const char *path;
    const cli_over *over;
    size_t poses; /* looked at */
    const csgm_clearances *pairs;
    double min_gap;
    bool between; /* what lies between poses has to be covered */
} cli_cleared;

/* How a pair went over all poses, and between them if that is asked for: the worst. */
typedef enum cli_verdict { CLI_PAIR_CLEAR, CLI_PAIR_OPEN, CLI_PAIR_BAD } cli_verdict;

cli_verdict cli_verdict_of(const cli_cleared *cleared, const csgm_clear_pair *pair);
/* "apart", "touching", "undecided" or "interfering". */
const char *cli_clear_state_name(csgm_clear_state state);
/* "lid" in quotes, or what the part without a name is called. */
const char *cli_clear_name(const char *name, char text[96]);
/* " at t = 0.3" of the worst pose, or nothing where there is one pose. */
void cli_clear_pose(const cli_cleared *cleared, const csgm_clear_pair *pair, char *text,
                    size_t size);
/* What is known between its poses, as a part of a sentence; of a pair with steps. */
void cli_clear_say_between(const cli_cleared *cleared, const csgm_clear_pair *pair, char *text,
                           size_t size);
/* One sentence: what is wrong with the pair, and at which pose. */
void cli_clear_say(const cli_cleared *cleared, const csgm_clear_pair *pair, char *text,
                   size_t size);

void cli_clear_json(const cli_cleared *cleared);
void cli_clear_text(const cli_cleared *cleared);
/* CLI_DONE or CLI_TROUBLE. */
int cli_clear_junit(cli_app *app, const cli_cleared *cleared);

#endif
