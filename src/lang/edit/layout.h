/* SPDX-License-Identifier: MIT
 * Where a piece stands in its statement: what follows from it is how far a line is indented and
 * whether a sign has one operand or two. Goes over the pieces once, in their order; any text will
 * do, also one that is no scene.
 */
#ifndef CSG_LANG_LAYOUT_H
#define CSG_LANG_LAYOUT_H

#include "lang/edit/pieces.h"

typedef enum csg_layout_state {
    CSG_LAYOUT_START, /* of a statement */
    CSG_LAYOUT_HEAD,  /* in it, before its children */
    CSG_LAYOUT_CHILD, /* its child comes next */
    CSG_LAYOUT_VALUE, /* behind the '=' of an assignment or a function */
    CSG_LAYOUT_PATH,  /* behind include and use */
    CSG_LAYOUT_ELSE   /* an else comes next */
} csg_layout_state;

/* A statement as far as it has been read. */
typedef struct csg_layout_statement {
    uint8_t state;   /* csg_layout_state */
    uint32_t base;   /* columns of its first line */
    uint32_t level;  /* how many of its children are indented, on a line of their own */
    uint32_t column; /* where the line of the statement, or of its last child, began in the text;
                        NONE: it stands behind others */
    uint32_t ifs;    /* those of csg_layout.ifs that belong to statements around it */
} csg_layout_statement;

/* A bracket that is open. */
typedef struct csg_layout_frame {
    uint8_t token;  /* csg_token_kind of the bracket */
    bool is_prefix; /* of for, if, let and their kind: an expression or a child follows */
    bool is_multi;  /* a block over several lines */
    uint32_t piece;
    uint32_t indent; /* of the line in which it was opened */
    uint32_t column; /* where that line began in the text */
    uint32_t was,
        now; /* columns of what stands behind it on its line, in the text and in the layout */
    csg_layout_statement around; /* of a block: the statement that it is a part of */
} csg_layout_frame;

typedef struct csg_layout {
    csg_memory *memory;
    const char *text;
    const csg_edit_pieces *pieces;
    csg_layout_frame *frames;
    size_t frame_count, frame_capacity;
    uint32_t *ifs; /* levels of the ifs that an else may belong to */
    size_t if_count, if_capacity;
    csg_layout_statement statement;
    uint32_t line_indent;  /* of the line that is being made */
    uint32_t line_column;  /* where the text's line began */
    uint8_t last;          /* csg_token_kind of the last token; END before the first */
    bool last_is_operand;  /* a sign behind it has two operands */
    bool last_is_sign;     /* it has one operand, or it is a modifier: no space behind it */
    bool last_ends_prefix; /* it is the ')' of a prefix */
} csg_layout;

enum {
    CSG_LAYOUT_STEP = 2,         /* columns of one level */
    CSG_LAYOUT_INDENT_MOST = 120 /* deeper levels are indented no farther: else endless nesting
                                    would make a text of its square */
};

void csg_layout_init(csg_layout *layout, csg_memory *memory, const char *text,
                     const csg_edit_pieces *pieces);
void csg_layout_release(csg_layout *layout);

/* The columns before a piece that begins a line; it is told that it does. */
uint32_t csg_layout_begin_line(csg_layout *layout, uint32_t piece);
/* How many blanks there are between the piece before and this one on one line. */
uint32_t csg_layout_gap(const csg_layout *layout, uint32_t piece);
/* May an else stand behind the brace that has just been closed? It is the if's own then, not that
 * of a child on a line of its own. */
bool csg_layout_else_joins(const csg_layout *layout);
/* Goes past the piece, which has got this column (NONE: it is not sure yet). False: no memory. */
bool csg_layout_pass(csg_layout *layout, uint32_t piece, uint32_t column);

/* Is the innermost open bracket a block over several lines? */
bool csg_layout_in_multi(const csg_layout *layout);

#endif
