/* colour.c - colours between two colours: RGB, HSV, CIE L*a*b*, and Msh, the polar form of L*a*b* that Kenneth
 * Moreland's "Diverging Color Maps for Scientific Visualization" (2009) works in. */
#include "colour.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void mix(const double a[3], const double b[3], double share, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = share < 1 ? a[i] + (b[i] - a[i]) * share : b[i];
}

/* ---- HSV ---- */

static void to_hsv(const double rgb[3], double hsv[3])
{
    double most = fmax(rgb[0], fmax(rgb[1], rgb[2])), least = fmin(rgb[0], fmin(rgb[1], rgb[2]));
    double range = most - least, sixths = 0;
    if (range > 0) {
        if (rgb[0] == most)
            sixths = (rgb[1] - rgb[2]) / range;
        else if (rgb[1] == most)
            sixths = 2 + (rgb[2] - rgb[0]) / range;
        else
            sixths = 4 + (rgb[0] - rgb[1]) / range;
    }
    hsv[0] = (sixths < 0 ? sixths + 6 : sixths) / 6;
    hsv[1] = most > 0 ? range / most : 0;
    hsv[2] = most;
}

static void from_hsv(const double hsv[3], double rgb[3])
{
    for (int i = 0; i < 3; i++) {
        /* How far the hue is from the channel's own, in sixths of the circle: 0 to 3. */
        double away = fabs(remainder(6 * hsv[0] - 2 * i, 6));
        double pure = fmin(fmax(2 - away, 0), 1);
        rgb[i] = hsv[2] * (1 - hsv[1] * (1 - pure));
    }
}

static void between_hsv(bool wrapped, const double from[3], const double to[3], double share, double rgb[3])
{
    double a[3], b[3], hsv[3];
    to_hsv(from, a);
    to_hsv(to, b);
    if (wrapped && fabs(a[0] - b[0]) > 0.5) {
        if (a[0] > b[0])
            a[0] -= 1;
        else
            b[0] -= 1;
    }
    mix(a, b, share, hsv);
    if (hsv[0] < 0)
        hsv[0] += 1;
    from_hsv(hsv, rgb);
}

/* ---- CIE L*a*b* ---- */

/* sRGB's linear channels to XYZ and back, to the four digits that its first edition prints. */
static const double xyz_of_rgb[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
static const double rgb_of_xyz[3][3] = {
    {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
static const double white_d65[3] = {0.9505, 1, 1.089};

static void multiply(const double matrix[3][3], const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
}

static void to_lab(const double rgb[3], double lab[3])
{
    double linear[3], xyz[3], f[3];
    for (int i = 0; i < 3; i++)
        linear[i] = rgb[i] > 0.04045 ? pow((rgb[i] + 0.055) / 1.055, 2.4) : rgb[i] / 12.92;
    multiply(xyz_of_rgb, linear, xyz);
    for (int i = 0; i < 3; i++) {
        double t = xyz[i] / white_d65[i];
        f[i] = t > 0.008856 ? cbrt(t) : 7.787 * t + 16.0 / 116;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]);
    lab[2] = 200 * (f[1] - f[2]);
}

/* Colours that no screen shows are scaled down, then cut off at 0. */
static void from_lab(const double lab[3], double rgb[3])
{
    double y = (lab[0] + 16) / 116, f[3] = {lab[1] / 500 + y, y, y - lab[2] / 200}, xyz[3], linear[3], largest = 1;
    for (int i = 0; i < 3; i++) {
        double cube = f[i] * f[i] * f[i];
        xyz[i] = white_d65[i] * (cube > 0.008856 ? cube : (f[i] - 16.0 / 116) / 7.787);
    }
    multiply(rgb_of_xyz, xyz, linear);
    for (int i = 0; i < 3; i++) {
        rgb[i] = linear[i] > 0.0031308 ? 1.055 * pow(linear[i], 1 / 2.4) - 0.055 : 12.92 * linear[i];
        largest = fmax(largest, rgb[i]);
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = fmax(rgb[i] / largest, 0);
}

static void between_lab(const double from[3], const double to[3], double share, double rgb[3])
{
    double a[3], b[3], lab[3];
    to_lab(from, a);
    to_lab(to, b);
    mix(a, b, share, lab);
    from_lab(lab, rgb);
}

/* ---- Msh: magnitude, saturation (the angle from grey), hue ---- */

static void to_msh(const double rgb[3], double msh[3])
{
    double lab[3];
    to_lab(rgb, lab);
    msh[0] = sqrt(lab[0] * lab[0] + lab[1] * lab[1] + lab[2] * lab[2]);
    msh[1] = msh[0] > 0.001 ? acos(lab[0] / msh[0]) : 0;
    msh[2] = msh[1] > 0.001 ? atan2(lab[2], lab[1]) : 0;
}

static void from_msh(const double msh[3], double rgb[3])
{
    const double lab[3] = {msh[0] * cos(msh[1]), msh[0] * sin(msh[1]) * cos(msh[2]),
                           msh[0] * sin(msh[1]) * sin(msh[2])};
    from_lab(lab, rgb);
}

/* The hue that a grey of magnitude `grey` is given, next to a saturated colour: spun away from it, so that the way
 * between them looks even, and never through purple. */
static double spun_hue(const double msh[3], double grey)
{
    if (msh[0] >= grey - 0.1)
        return msh[2];
    double spin = msh[1] * sqrt(grey * grey - msh[0] * msh[0]) / (msh[0] * sin(msh[1]));
    return msh[2] > -0.3 * pi ? msh[2] + spin : msh[2] - spin;
}

static void between_diverging(const double from[3], const double to[3], double share, double rgb[3])
{
    const double saturated = 0.05;
    double a[3], b[3], msh[3];
    to_msh(from, a);
    to_msh(to, b);
    if (a[1] > saturated && b[1] > saturated && fabs(remainder(a[2] - b[2], 2 * pi)) > 0.33 * pi) {
        const double white[3] = {fmax(fmax(a[0], b[0]), 88), 0, 0};
        memcpy(share < 0.5 ? b : a, white, sizeof white);
        share = share < 0.5 ? 2 * share : 2 * share - 1;
    }
    if (a[1] < saturated && b[1] > saturated)
        a[2] = spun_hue(b, a[0]);
    else if (b[1] < saturated && a[1] > saturated)
        b[2] = spun_hue(a, b[0]);
    mix(a, b, share, msh);
    from_msh(msh, rgb);
}

void colour_between(colour_space space, const double from[3], const double to[3], double share, double rgb[3])
{
    switch (space) {
    case COLOUR_HSV:
    case COLOUR_HSV_WRAPPED: between_hsv(space == COLOUR_HSV_WRAPPED, from, to, share, rgb); break;
    case COLOUR_LAB: between_lab(from, to, share, rgb); break;
    case COLOUR_DIVERGING: between_diverging(from, to, share, rgb); break;
    default: mix(from, to, share, rgb);
    }
    for (int i = 0; i < 3; i++)
        rgb[i] = fmin(fmax(rgb[i], 0), 1);
}
