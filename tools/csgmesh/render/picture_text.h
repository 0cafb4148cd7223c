/* SPDX-License-Identifier: MIT
 * Pictures put together by hand: rectangles, other pictures, rings, and words in capitals.
 */
#ifndef CLI_PICTURE_TEXT_H
#define CLI_PICTURE_TEXT_H

#include <stdint.h>

typedef struct cli_canvas {
    uint32_t width, height;
    uint8_t *pixels; /* sRGB and alpha, rows from the top */
} cli_canvas;

/* What lies outside the canvas is left out, everywhere. */
void cli_canvas_fill(cli_canvas *canvas, int x, int y, int width, int height,
                     const uint8_t color[3]);
void cli_canvas_ring(cli_canvas *canvas, int x, int y, int radius, int width,
                     const uint8_t color[3]);
/* Letters of 5 x 7 squares of `size` pixels; small letters are drawn as capitals, what the table
 * lacks as a blank. Returns the x after the last one. */
int cli_canvas_text(cli_canvas *canvas, int x, int y, int size, const uint8_t color[3],
                    const char *text);
int cli_canvas_text_width(int size, const char *text);

#endif
