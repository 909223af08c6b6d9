/* orientation.c - which file axis runs right, up and towards the eye at view 0,0. */
#include "orientation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void orientation_of_patient(const double ras[3], double world[3])
{
    world[0] = -ras[0];
    world[1] = ras[2];
    world[2] = ras[1];
}

static double cosine(const double direction[3], int world_axis)
{
    double largest = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
    if (!(largest > 0))
        return 0;
    double sum = 0;
    for (int w = 0; w < 3; w++)
        sum += (direction[w] / largest) * (direction[w] / largest);
    double result = direction[world_axis] / largest / sqrt(sum);
    return isfinite(result) ? result : 0;
}

bool orientation_is_sound(const double direction[3][3])
{
    /* Skewed axes are seen as they are not, but three there must be. */
    const double least = 1e-3;
    double c[3][3];
    for (int i = 0; i < 3; i++)
        for (int w = 0; w < 3; w++)
            c[i][w] = cosine(direction[i], w);
    double spanned = c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) +
                     c[0][1] * (c[1][2] * c[2][0] - c[1][0] * c[2][2]) +
                     c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0]);
    return fabs(spanned) > least;
}

void orientation_nearest(const double direction[3][3], int axis[3], int sign[3])
{
    static const int permutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    /* Oblique directions tie only up to rounding. */
    const double tie = 1e-6;
    double best = -1;
    for (int p = 0; p < 6; p++) {
        double sum = 0;
        for (int w = 0; w < 3; w++)
            sum += fabs(cosine(direction[permutations[p][w]], w));
        if (sum > best + tie) {
            best = sum;
            memcpy(axis, permutations[p], sizeof permutations[p]);
        }
    }
    for (int w = 0; w < 3; w++)
        sign[w] = direction[axis[w]][w] < 0 ? -1 : 1;
}

void orientation_words(const volume *v, char *text, size_t size)
{
    const char names[] = "xyz";
    snprintf(text, size, "right %c%c, up %c%c, towards the eye %c%c", v->sign[0] > 0 ? '+' : '-', names[v->axis[0]],
             v->sign[1] > 0 ? '+' : '-', names[v->axis[1]], v->sign[2] > 0 ? '+' : '-', names[v->axis[2]]);
}
