/* sweep_plot_script.c - gnuplot scripts for a sweep. Colours are Okabe and Ito's, which the colour-blind can tell
 * apart, and lines differ in their points too; heat maps are viridis, which is even in grey. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gnuplot.h"
#include "sweep_plot.h"

enum { COLOURS = 8, MOST_LABELS = 20, MOST_CELL_TEXTS = 150, LABEL_CHARS = 160, LONG_AXIS = 12 };

static const char *const colours[COLOURS] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#000000", "#8C8C00"};
static const int points[COLOURS] = {7, 5, 9, 13, 11, 6, 4, 8};

typedef struct plot {
    FILE *script;
    const sweep_plot *choice;
    const sweep_plan *plan;
    const sweep_columns *columns;
    const sweep_objectives *objectives;
    const sweep_rows *rows;
    size_t values; /* of a row */
    size_t xs, series;
    double *mean; /* mean[s*xs + x], not a number where every point was refused */
} plot;

/* ---- words ---- */

/* Thousands that keep a figure short: its factor and word. */
static double scale_of(double largest, const char **word)
{
    static const struct {
        double factor;
        const char *word;
    } scales[] = {{1e12, "trillion "}, {1e9, "billion "}, {1e6, "million "}, {1e4, "thousand "}};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++)
        if (largest >= scales[i].factor) {
            *word = scales[i].word;
            return scales[i].factor == 1e4 ? 1e3 : scales[i].factor;
        }
    *word = "";
    return 1;
}

/* "offchip_bytes (million bytes)" */
static void name_with_unit(const plot *p, const char *name, const char *scale, char text[LABEL_CHARS])
{
    const char *unit = sweep_column_unit(p->plan, name);
    if (!*unit && *scale)
        unit = "";
    int n = snprintf(text, LABEL_CHARS, "%s", name);
    if (*unit || *scale)
        snprintf(text + n, (size_t)(LABEL_CHARS - n), " (%s%s)", scale, unit);
    char *blank = strstr(text, " )");
    if (blank)
        strcpy(blank, ")");
}

/* An axis's names: "cache_bytes (bytes)"; views that turn: the angle. */
static void axis_label(const plot *p, size_t axis, char text[LABEL_CHARS])
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < p->plan->name_count; i++) {
        char one[LABEL_CHARS];
        if (p->plan->names[i].axis != axis)
            continue;
        name_with_unit(p, p->plan->names[i].name, "", one);
        if (strcmp(one, "view") == 0 && sweep_plot_is_numeric(p->plan, axis))
            snprintf(one, sizeof one, "view: azimuth (degrees)");
        int n = snprintf(text + used, LABEL_CHARS - used, "%s%s", used ? ", " : "", one);
        used = used + (size_t)n < LABEL_CHARS ? used + (size_t)n : LABEL_CHARS - 1;
    }
}

/* A value of an axis in short: numbers as such, files without their directories. */
static void value_label(const plot *p, size_t axis, size_t index, char text[LABEL_CHARS])
{
    const sweep_axis *a = &p->plan->axes[axis];
    size_t used = 0;
    text[0] = '\0';
    if (sweep_plot_is_numeric(p->plan, axis)) {
        snprintf(text, LABEL_CHARS, "%.10g", sweep_plot_number(p->plan, axis, index));
        return;
    }
    for (size_t i = 0; i < a->names; i++) {
        const char *value = a->values[index * a->names + i], *slash = strrchr(value, '/');
        int n = snprintf(text + used, LABEL_CHARS - used, "%s%s", i ? " " : "", slash ? slash + 1 : value);
        used = used + (size_t)n < LABEL_CHARS ? used + (size_t)n : LABEL_CHARS - 1;
    }
}

/* A datum of text. */
static void put_datum(FILE *script, const char *text)
{
    putc('"', script);
    for (; *text; text++)
        putc(*text == '"' || *text == '\\' || (unsigned char)*text < ' ' ? '_' : *text, script);
    putc('"', script);
}

static void set(const plot *p, const char *what, const char *text)
{
    fprintf(p->script, "set %s ", what);
    gnuplot_quote(p->script, text);
    putc('\n', p->script);
}

/* ---- data ---- */

/* Means over all axes but two. */
static host_status average(plot *p, host_error *error)
{
    const size_t cells = p->xs * p->series;
    uint64_t *count = calloc(cells, sizeof *count);
    p->mean = calloc(cells, sizeof *p->mean);
    if (!count || !p->mean) {
        free(count);
        return host_fail(error, HOST_ENVIRONMENT, "no memory for a plot of %zu values", cells);
    }
    for (uint64_t point = 0; point < p->rows->count; point++) {
        const double value = p->rows->values[(point + 1) * p->values - 1];
        size_t cell = sweep_plan_index(p->plan, p->choice->across, point);
        if (p->series > 1)
            cell += p->xs * sweep_plan_index(p->plan, p->choice->series, point);
        if (isnan(value))
            continue;
        p->mean[cell] += value;
        count[cell]++;
    }
    for (size_t i = 0; i < cells; i++)
        p->mean[i] = count[i] ? p->mean[i] / (double)count[i] : NAN;
    free(count);
    return HOST_OK;
}

static void range_of(const double *values, size_t count, size_t step, double *least, double *largest)
{
    *least = HUGE_VAL;
    *largest = -HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        *least = fmin(*least, values[i * step]);
        *largest = fmax(*largest, values[i * step]);
    }
}

/* What the plot shows: column, what of its values is averaged, and of what sweep. */
static void put_title(const plot *p)
{
    char title[1024];
    size_t used = (size_t)snprintf(title, sizeof title, "%s", p->columns->names[p->choice->column]);
    bool first = true;
    for (size_t a = 0; a < p->plan->axis_count; a++) {
        char label[LABEL_CHARS];
        if (a == p->choice->across || a == p->choice->series || p->plan->axes[a].count < 2 || used >= sizeof title)
            continue;
        axis_label(p, a, label);
        label[strcspn(label, "(:")] = '\0';
        size_t n = strlen(label);
        while (n && label[n - 1] == ' ')
            label[--n] = '\0';
        used += (size_t)snprintf(title + used, sizeof title - used, "%s%zu values of %s", first ? ", mean over " : ", ",
                                 p->plan->axes[a].count, label);
        first = false;
    }
    set(p, "title", title);
}

static void put_frame(const plot *p)
{
    fputs("set terminal svg size 960,560 dynamic noenhanced font 'sans,14' background 'white'\n"
          "set datafile missing 'NaN'\nset border 3\nset tics nomirror out\nset grid ytics lc rgb '#d0d0d0'\n"
          "set lmargin 12\n",
          p->script);
}

/* ---- kinds ---- */

static bool are_powers_of_two(const plot *p)
{
    for (size_t i = 0; i < p->xs; i++) {
        int exponent;
        if (frexp(sweep_plot_number(p->plan, p->choice->across, i), &exponent) != 0.5)
            return false;
    }
    return p->xs > 2;
}

/* x, then a value a series. */
static void put_table(const plot *p, bool numeric, double scale)
{
    fputs("$data << EOD\n", p->script);
    for (size_t x = 0; x < p->xs; x++) {
        char label[LABEL_CHARS];
        value_label(p, p->choice->across, x, label);
        if (numeric)
            fprintf(p->script, "%.10g", sweep_plot_number(p->plan, p->choice->across, x));
        else
            put_datum(p->script, label);
        for (size_t s = 0; s < p->series; s++)
            fprintf(p->script, " %.10g", p->mean[s * p->xs + x] / scale);
        putc('\n', p->script);
    }
    fputs("EOD\n", p->script);
}

static void put_series_title(const plot *p, size_t s)
{
    char label[LABEL_CHARS];
    if (p->series == 1) {
        fputs(" notitle", p->script);
        return;
    }
    value_label(p, p->choice->series, s, label);
    fputs(" title ", p->script);
    gnuplot_quote(p->script, label);
}

/* Axes, title and key of lines and bars; returns what values are divided by. */
static double put_axes(const plot *p)
{
    char label[LABEL_CHARS];
    double least, largest;
    const char *word;
    range_of(p->mean, p->xs * p->series, 1, &least, &largest);
    const double scale = scale_of(largest, &word);
    name_with_unit(p, p->columns->names[p->choice->column], word, label);
    set(p, "ylabel", label);
    axis_label(p, p->choice->across, label);
    set(p, "xlabel", label);
    put_title(p);
    if (p->series > 1) {
        axis_label(p, p->choice->series, label);
        fputs("set key outside right top\n", p->script);
        set(p, "key title", label);
    }
    if (p->choice->type == SWEEP_PLOT_BAR || least < largest / 2)
        fputs("set yrange [0:*]\n", p->script);
    return scale;
}

/* From the first value to the last; a turn in quarters and eighths. */
static void put_x_range(const plot *p)
{
    double least = HUGE_VAL, largest = -HUGE_VAL;
    for (size_t x = 0; x < p->xs; x++) {
        const double value = sweep_plot_number(p->plan, p->choice->across, x);
        least = fmin(least, value);
        largest = fmax(largest, value);
    }
    if (least < largest)
        fprintf(p->script, "set xrange [%.10g:%.10g]\n", least, largest);
    if (sweep_plan_find(p->plan, "view") < p->plan->name_count && largest - least >= 180 && largest - least <= 360 &&
        p->plan->names[sweep_plan_find(p->plan, "view")].axis == p->choice->across)
        fputs("set xtics 45\n", p->script);
}

static void put_line(const plot *p)
{
    const double scale = put_axes(p);
    put_table(p, true, scale);
    if (are_powers_of_two(p)) {
        fputs("set logscale x 2\nset xtics (", p->script);
        for (size_t x = 0; x < p->xs; x++)
            fprintf(p->script, "%s%.10g", x ? ", " : "", sweep_plot_number(p->plan, p->choice->across, x));
        fputs(")\n", p->script);
    }
    put_x_range(p);
    for (size_t s = 0; s < p->series; s++) {
        fprintf(p->script, "%s$data using 1:%zu with linespoints lw 2 ps %s lc rgb '%s' pt %d dt %zu",
                s ? ", " : "plot ", s + 2, p->xs > LONG_AXIS ? "0.5" : "0.9", colours[s % COLOURS], points[s % COLOURS],
                s % 4 + 1);
        put_series_title(p, s);
    }
    putc('\n', p->script);
}

static void put_bar(const plot *p)
{
    const double scale = put_axes(p);
    put_table(p, false, scale);
    fputs("set style data histograms\nset style histogram clustered gap 1\nset style fill solid 0.9 border lc rgb "
          "'white'\n"
          "set boxwidth 0.95\n",
          p->script);
    if (p->xs > 6)
        fputs("set xtics rotate by 45 right\n", p->script);
    for (size_t s = 0; s < p->series; s++) {
        fprintf(p->script, "%s$data using %zu:xtic(1) lc rgb '%s'", s ? ", " : "plot ", s + 2, colours[s % COLOURS]);
        put_series_title(p, s);
    }
    putc('\n', p->script);
}

/* Labels of an axis whose values lie at 0, 1, ...; of a long one, some. */
static void put_index_tics(const plot *p, const char *side, size_t axis)
{
    const size_t count = p->plan->axes[axis].count, step = (count + 17) / 18;
    fprintf(p->script, "set %stics (", side);
    for (size_t i = 0; i < count; i += step) {
        char label[LABEL_CHARS];
        value_label(p, axis, i, label);
        fputs(i ? ", " : "", p->script);
        gnuplot_quote(p->script, label);
        fprintf(p->script, " %zu", i);
    }
    fprintf(p->script, ")%s\n", strcmp(side, "x") == 0 && count > 6 ? " rotate by 45 right" : "");
}

static void put_heat(const plot *p)
{
    char label[LABEL_CHARS];
    const char *word;
    double least, largest;
    range_of(p->mean, p->xs * p->series, 1, &least, &largest);
    const double scale = scale_of(largest, &word);
    fputs("unset grid\nset border 15\nset rmargin 14\n"
          "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n",
          p->script);
    put_title(p);
    name_with_unit(p, p->columns->names[p->choice->column], word, label);
    set(p, "cblabel", label);
    axis_label(p, p->choice->across, label);
    set(p, "xlabel", label);
    axis_label(p, p->choice->series, label);
    set(p, "ylabel", label);
    put_index_tics(p, "x", p->choice->across);
    put_index_tics(p, "y", p->choice->series);
    fputs("$data << EOD\n", p->script);
    for (size_t s = 0; s < p->series; s++)
        for (size_t x = 0; x < p->xs; x++) {
            const double value = p->mean[s * p->xs + x];
            fprintf(p->script, "%zu %zu %.10g \"%.3g\" %d\n", x, s, value / scale, value / scale,
                    value - least > 0.6 * (largest - least) ? 0 : 0xffffff);
        }
    fprintf(p->script, "EOD\nset xrange [-0.5:%zu.5]\nset yrange [-0.5:%zu.5]\n", p->xs - 1, p->series - 1);
    fputs("plot $data using 1:2:3 with image pixels notitle", p->script);
    if (p->xs * p->series <= MOST_CELL_TEXTS)
        fputs(", $data using 1:2:4:5 with labels textcolor rgb variable font ',11' notitle", p->script);
    putc('\n', p->script);
}

/* What tells a point from the others. */
static void point_label(const plot *p, uint64_t point, char text[LABEL_CHARS])
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t a = 0; a < p->plan->axis_count; a++) {
        char value[LABEL_CHARS];
        if (p->plan->axes[a].count < 2)
            continue;
        value_label(p, a, sweep_plan_index(p->plan, a, point), value);
        int n = snprintf(text + used, LABEL_CHARS - used, "%s%s", used ? "  " : "", value);
        used = used + (size_t)n < LABEL_CHARS ? used + (size_t)n : LABEL_CHARS - 1;
    }
}

static void put_label(const plot *p, const char *text, int row)
{
    fputs("set label ", p->script);
    gnuplot_quote(p->script, text);
    fprintf(p->script, " at graph 1.03, graph %.3f left font ',11'\n", 0.97 - 0.048 * row);
}

/* The points of the front by number, beside the plot; how they are called, on top. */
static void put_front_list(const plot *p)
{
    char text[LABEL_CHARS + 16] = "";
    int number = 0, row = 0;
    fputs("set rmargin 38\n", p->script);
    for (size_t i = 0; i < p->plan->name_count; i++) {
        const size_t used = strlen(text);
        if (p->plan->axes[p->plan->names[i].axis].count > 1 && used < sizeof text)
            snprintf(text + used, sizeof text - used, "%s%s", used ? ", " : "", p->plan->names[i].name);
    }
    put_label(p, text, row++);
    for (uint64_t i = 0; i < p->rows->count; i++) {
        char label[LABEL_CHARS];
        if (!p->rows->marks[i])
            continue;
        point_label(p, i, label);
        snprintf(text, sizeof text, "%d:  %s", ++number, label);
        put_label(p, text, ++row);
    }
}

/* Label, and a logarithmic scale where values lie decades apart; returns what they are divided by. */
static double put_objective_axis(const plot *p, const char *side, size_t objective)
{
    char label[LABEL_CHARS], what[16];
    double least, largest;
    const char *word, *name = p->columns->names[p->objectives->column[objective]];
    range_of(p->rows->values + objective, (size_t)p->rows->count, p->values, &least, &largest);
    const double scale = scale_of(largest, &word);
    name_with_unit(p, name, word, label);
    size_t n = strlen(label);
    snprintf(label + n, sizeof label - n, p->objectives->largest[objective] ? ", more is better" : ", less is better");
    snprintf(what, sizeof what, "%slabel", side);
    set(p, what, label);
    if (least > 0 && largest > 50 * least)
        fprintf(p->script, "set logscale %s\n", side);
    return scale;
}

static void put_pareto(const plot *p)
{
    char title[128];
    const double x_scale = put_objective_axis(p, "x", 0), y_scale = put_objective_axis(p, "y", 1);
    snprintf(title, sizeof title, "%llu points, %llu of them on the front%s", (unsigned long long)p->rows->count,
             (unsigned long long)p->rows->front, p->objectives->count > 2 ? " of more objectives than these two" : "");
    set(p, "title", title);
    const bool listed = p->rows->front <= MOST_LABELS;
    int number = 0;
    fputs("set grid xtics ytics lc rgb '#d0d0d0'\nset key outside top center horizontal\n"
          "set offsets graph 0.04, graph 0.04, graph 0.06, graph 0.06\n",
          p->script);
    if (listed)
        put_front_list(p);
    for (int front = 0; front < 2; front++) {
        fprintf(p->script, "$%s << EOD\n", front ? "front" : "beaten");
        for (uint64_t i = 0; i < p->rows->count; i++) {
            const double *v = p->rows->values + i * p->values;
            if (p->rows->marks[i] != (front == 1) || isnan(v[0]) || isnan(v[1]))
                continue;
            number += front;
            fprintf(p->script, "%.10g %.10g %d\n", v[0] / x_scale, v[1] / y_scale, number);
        }
        fputs("NaN NaN 0\nEOD\n", p->script);
    }
    fputs("plot $beaten using 1:2 with points pt 7 ps 0.5 lc rgb '#999999' title 'beaten by another', "
          "$front using 1:2 with points pt 5 ps 1 lc rgb '#D55E00' title 'Pareto front'",
          p->script);
    if (p->objectives->count == 2)
        fputs(", $front using 1:2 smooth unique with lines lw 1.5 lc rgb '#D55E00' notitle", p->script);
    if (listed)
        fputs(", $front using 1:(int($3) % 2 ? $2 : NaN):3 with labels left offset 0.6,0.7 font ',12' notitle"
              ", $front using 1:(int($3) % 2 ? NaN : $2):3 with labels right offset -0.6,-0.7 font ',12' notitle",
              p->script);
    putc('\n', p->script);
}

host_status sweep_plot_script(FILE *script, const sweep_plot *choice, const sweep_plan *plan, const sweep_columns *c,
                              const sweep_objectives *o, const sweep_rows *r, host_error *error)
{
    plot p = {script, choice, plan, c, o, r, o->count + 1, 1, 1, NULL};
    put_frame(&p);
    if (choice->type == SWEEP_PLOT_PARETO) {
        put_pareto(&p);
        return HOST_OK;
    }
    p.xs = plan->axes[choice->across].count;
    p.series = choice->series < plan->axis_count ? plan->axes[choice->series].count : 1;
    host_status status = average(&p, error);
    if (status == HOST_OK) {
        choice->type == SWEEP_PLOT_LINE ? put_line(&p) : choice->type == SWEEP_PLOT_BAR ? put_bar(&p) : put_heat(&p);
    }
    free(p.mean);
    return status;
}
