/* SPDX-License-Identifier: MIT
 * A text as an editor sees it: its tokens with the comments between them, where lines break, and
 * which brackets belong together. Nothing is dropped but white space.
 */
#ifndef CSG_LANG_EDIT_PIECES_H
#define CSG_LANG_EDIT_PIECES_H

#include "text/lexer.h"

typedef enum csg_edit_piece_kind {
    CSG_EDIT_TOKEN,
    CSG_EDIT_LINE_COMMENT, /* without its line break, and without spaces before that */
    CSG_EDIT_BLOCK_COMMENT
} csg_edit_piece_kind;

enum { CSG_EDIT_NONE = UINT32_MAX };

typedef struct csg_edit_piece {
    uint8_t kind;  /* csg_edit_piece_kind */
    uint8_t token; /* csg_token_kind of a TOKEN; END for comments */
    uint32_t offset, length;
    uint32_t line;   /* on which it begins, from 0 */
    uint32_t breaks; /* ends of lines between the piece before it and this one */
    uint32_t column; /* characters before it on its line; tabs go to multiples of 8 */
    uint32_t mate;   /* of a bracket: the piece that it belongs to; else NONE */
} csg_edit_piece;

/* The last one is the END token. */
typedef struct csg_edit_pieces {
    csg_edit_piece *items; /* from the context's memory */
    size_t count, capacity;
} csg_edit_pieces;

/* False when memory ran out (not reported). What the lexer finds is reported as ever. Release the
 * pieces in either case. */
bool csg_edit_pieces_read(const csg_sources *sources, uint32_t source, csg_edit_pieces *out);
void csg_edit_pieces_release(csg_memory *memory, csg_edit_pieces *pieces);

/* Finds the mates. Reports the first bracket that has none, with the place of the other, and is
 * false then; also without memory, which sets *no_memory. sources NULL: nothing is reported, and
 * brackets are matched as far as that goes. */
bool csg_edit_pieces_match(csg_memory *memory, csg_edit_pieces *pieces, const csg_sources *sources,
                           uint32_t source, bool *no_memory);

bool csg_token_opens(csg_token_kind kind);  /* ( [ { */
bool csg_token_closes(csg_token_kind kind); /* ) ] } */

/* The column behind text that begins at `column`. */
uint32_t csg_column_behind(uint32_t column, const char *text, size_t length);

#endif
