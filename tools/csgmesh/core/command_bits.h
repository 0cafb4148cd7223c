/* SPDX-License-Identifier: MIT
 * Sets of commands, as the rows of options.def name them: MESH | INFO.
 */
#ifndef CLI_COMMAND_BITS_H
#define CLI_COMMAND_BITS_H

#include "core/commands.h"

enum {
#define COMMAND(NAME, name, operands, summary, examples) NAME = 1 << CLI_##NAME,
#include "core/commands.def"
#undef COMMAND
    ANY = ((1 << CLI_COMMAND_COUNT) - 1) & ~OPENSCAD,      /* which has options of its own */
    ANY_WORK = ANY & ~(HELP | VERSION | MAN | COMPLETION), /* these only talk */
    ANY_SCENE = ANY_WORK & ~(FORMAT | CONVERT)             /* which evaluate nothing */
};

#endif
