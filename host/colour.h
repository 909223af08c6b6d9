/* colour.h - colours between two colours, in the colour spaces of VTK's colour transfer function. */
#ifndef HOST_COLOUR_H
#define HOST_COLOUR_H

typedef enum colour_space {
    COLOUR_RGB,         /* linear in the channels as they are */
    COLOUR_HSV,         /* hue from 0 to 1, never through 0 */
    COLOUR_HSV_WRAPPED, /* hue the shorter way round */
    COLOUR_LAB,         /* CIE L*a*b* of sRGB, white point D65 */
    COLOUR_DIVERGING,   /* Moreland's Msh, through white between two saturated colours of different hue */
} colour_space;

/* The colour (r, g, b from 0 to 1) at `share`, 0 to 1, of the way: docs/transfer-functions.md has the formulas. */
void colour_between(colour_space space, const double from[3], const double to[3], double share, double rgb[3]);

#endif
