/* test_paraview.c - colour maps of ParaView: what VTK makes of the same points, defaults, and files of the wrong shape.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "transfer.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* Opens `text` as a transfer-function file. */
static host_status open_text(const char *text, transfer *t, host_error *error)
{
    char path[] = "/tmp/vodr-paraview-XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), strlen(text));
    close(descriptor);
    host_status status = transfer_open(path, false, t, error);
    unlink(path);
    return status;
}

static transfer opened(const char *text)
{
    transfer t;
    host_error error;
    if (open_text(text, &t, &error) != HOST_OK)
        fail_msg("%s", error.text);
    return t;
}

static bool near(double a, double b)
{
    return fabs(a - b) < 1e-11;
}

/* The expected values are those of VTK 9.1's vtkColorTransferFunction. */
static void colours_are_vtks(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double xrgb[6][4];
    } maps[] = {
        {"{\"ColorSpace\":\"RGB\",\"RGBPoints\":[-100,0.1,0.2,0.9,50,1,1,0.5,400,0.7,0,0]}",
         {{-150, 0.1, 0.2, 0.9},
          {-35, 0.49, 0.546666666667, 0.726666666667},
          {55, 0.995714285714, 0.985714285714, 0.492857142857},
          {150, 0.914285714286, 0.714285714286, 0.357142857143},
          {285, 0.798571428571, 0.328571428571, 0.164285714286},
          {380, 0.717142857143, 0.0571428571429, 0.0285714285714}}},
        {"{\"ColorSpace\":\"HSV\",\"RGBPoints\":[0,1,0.3,0.1,10,0.8,0.1,0.6,25,0.1,0.9,0.2]}",
         {{-2.5, 1, 0.3, 0.1},
          {3.25, 0.211291216518, 0.935, 0.101096875},
          {7.75, 0.209833493304, 0.100871875, 0.845},
          {12.5, 0.6439453125, 0.100192901235, 0.816666666667},
          {19.25, 0.100328317901, 0.605394740341, 0.861666666667},
          {24, 0.100086419753, 0.893333333333, 0.366390740741}}},
        {"{\"ColorSpace\":\"HSV\",\"HSVWrap\":1,\"RGBPoints\":[0,1,0.3,0.1,10,0.8,0.1,0.6,25,0.1,0.9,0.2]}",
         {{-2.5, 1, 0.3, 0.1},
          {3.25, 0.935, 0.101096875, 0.169596060268},
          {7.75, 0.845, 0.100871875, 0.475593537946},
          {12.5, 0.816666666667, 0.100192901235, 0.272914255401},
          {19.25, 0.833796244971, 0.861666666667, 0.100328317901},
          {24, 0.151080864198, 0.893333333333, 0.100086419753}}},
        {"{\"ColorSpace\":\"Lab\",\"RGBPoints\":[0,0,0,1,1,1,1,0,3,0.2,0.7,0.1]}",
         {{-0.3, 0, 0, 1},
          {0.39, 0.717158935176, 0.442713080058, 0.742900995352},
          {0.93, 0.980120857795, 0.935038574915, 0.242661470664},
          {1.5, 0.822432715837, 0.926761424053, 0.045896393933},
          {2.31, 0.524378315875, 0.80572744484, 0.0846772337948},
          {2.88, 0.273054631512, 0.718588171312, 0.0980817143688}}},
        {"{\"ColorSpace\":\"Diverging\",\"RGBPoints\":[-1000,0.231373,0.298039,0.752941,0,0.865003,0.865003,0.865003,"
         "1500,0.705882,0.0156863,0.14902]}",
         {{-1250, 0.231373, 0.298039, 0.752941},
          {-675, 0.433705817675, 0.567059098627, 0.9500381546},
          {-225, 0.738138230088, 0.822216829771, 0.969040040149},
          {250, 0.938290548952, 0.810060967286, 0.742693337978},
          {925, 0.927195092877, 0.504903017584, 0.393840084352},
          {1400, 0.755781436808, 0.163741063515, 0.185444839341}}},
        {"{\"ColorSpace\":\"Diverging\",\"RGBPoints\":[0,0.085,0.532,0.201,10,0.436,0.308,0.631,20,0,0,0]}",
         {{-2, 0.085, 0.532, 0.201},
          {2.6, 0.488445877173, 0.794668472341, 0.647794342474},
          {6.2, 0.907007936957, 0.740228681003, 0.799246139083},
          {10, 0.436008882856, 0.308007332496, 0.631001802964},
          {15.4, 0.272214907479, 0.240734894899, 0.31000260243},
          {19.2, 0.0686041367138, 0.0674620378716, 0.0698131972884}}},
    };
    for (size_t i = 0; i < COUNT(maps); i++) {
        transfer t = opened(maps[i].text);
        for (size_t n = 0; n < 6; n++) {
            const double *want = maps[i].xrgb[n];
            transfer_point p = transfer_at(&t, want[0], 0, 1);
            if (!near(p.r, want[1]) || !near(p.g, want[2]) || !near(p.b, want[3]))
                fail_msg("%s at %g: %.12g %.12g %.12g", maps[i].text, want[0], p.r, p.g, p.b);
        }
        transfer_close(&t);
    }
}

/* Midpoints and sharpnesses from linear to a step; the expected values are those of VTK 9.1's vtkPiecewiseFunction. */
static void opacities_are_vtks(void **state)
{
    (void)state;
    transfer t = opened("[{\"ColorSpace\":\"RGB\",\"RGBPoints\":[0,0,0,0],\"Points\":[0,0.1,0.5,0, 10,0.9,0.2,0.3, "
                        "20,0.2,0.8,0.7, 30,0.6,0.5,1, 40,0,0.5,0.5]}]");
    static const double want[][2] = {
        {-1, 0.1},
        {3, 0.34},
        {10, 0.9},
        {11.5, 0.808375693113},
        {13, 0.387158501198},
        {17, 0.204906157602},
        {19.5, 0.20000373844},
        {22, 0.200000915576},
        {25, 0.201509941566},
        {27.5, 0.295705390081},
        {29, 0.599762424827},
        {33, 0.6},
        {35, 0},
        {35.5, 0},
        {41, 0},
    };
    for (size_t i = 0; i < COUNT(want); i++)
        if (!near(transfer_at(&t, want[i][0], 0, 1).a, want[i][1]))
            fail_msg("at %g: %.12g", want[i][0], transfer_at(&t, want[i][0], 0, 1).a);
    transfer_close(&t);
}

static void defaults(void **state)
{
    (void)state;
    transfer t = opened("\n {\"RGBPoints\":[100,0,0,0,300,1,1,0.5], \"NanColor\":[9,9,9], \"Other\":{}}");
    transfer_point p = transfer_at(&t, 200, 0, 1);
    assert_true(near(p.r, 0.5) && near(p.b, 0.25) && near(p.a, 0.025));
    assert_true(transfer_at(&t, -5, 0, 1).a == 0 && transfer_at(&t, 1e9, 0, 1).a == 0.05);
    transfer_close(&t);
    t = opened("[{\"RGBPoints\":[7,1,0,0]}, 3]");
    assert_true(transfer_at(&t, -5, 0, 1).a == 0.05 && transfer_at(&t, 9, 0, 1).r == 1);
    transfer_close(&t);
    t = opened("{\"RGBPoints\":[0,0,0,0,1,1,1,1],\"Normalized\":true}");
    assert_true(near(transfer_at(&t, 150, 100, 200).g, 0.5));
    transfer_close(&t);
}

/* No colour of the table exceeds its opacity, as 8 and as 16 bits. */
static void tables_are_premultiplied(void **state)
{
    (void)state;
    static const char *const spaces[] = {"RGB", "HSV", "Lab", "Diverging"};
    static vodr_rgba entries[4096];
    for (size_t i = 0; i < COUNT(spaces); i++)
        for (int bits = 8; bits <= 16; bits += 8) {
            char text[256];
            snprintf(text, sizeof text,
                     "{\"ColorSpace\":\"%s\",\"HSVWrap\":1,\"RGBPoints\":[0,1,1,0,1,1,0,1,2,0,1,1,3,1,0,0],"
                     "\"Points\":[0,0,0.5,0,3,1,0.3,0.4]}",
                     spaces[i]);
            transfer t = opened(text);
            transfer_table(&t, 0, 3, 12, bits, 1, false, entries);
            for (int n = 0; n < 4096; n++)
                assert_true(entries[n].r <= entries[n].a && entries[n].g <= entries[n].a &&
                            entries[n].b <= entries[n].a);
            assert_int_equal(entries[4095].a, bits == 8 ? 255 : 65535);
            transfer_close(&t);
        }
}

static void bad_files(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"[", ":1: is no valid JSON"},
        {"[{\"]}\\\n\n", "is no valid JSON"}, /* jansson quotes the line's end */
        {"{\"RGBPoints\":[0,0,0,NaN]}", "is no valid JSON"},
        {"{\"RGBPoints\":[0,0,0,1e999]}", "is no valid JSON"},
        {"{\"Name\":1,\"Name\":2}", "is no valid JSON"},
        {"[]", "must be a colour map of ParaView"},
        {"[1]", "must be a colour map of ParaView"},
        {"{}", "\"RGBPoints\" must be a list of one or more times 4 numbers"},
        {"{\"RGBPoints\":[]}", "\"RGBPoints\" must be a list"},
        {"{\"RGBPoints\":[0,0,0]}", "\"RGBPoints\" must be a list"},
        {"{\"RGBPoints\":{\"x\":0}}", "\"RGBPoints\" must be a list"},
        {"{\"RGBPoints\":[0,0,\"0\",0]}", "element 2 of \"RGBPoints\" is no number"},
        {"{\"RGBPoints\":[0,0,0,1.5]}", "element 3 of \"RGBPoints\" is 1.5, must be 0 to 1"},
        {"{\"RGBPoints\":[0,0,0,0,0,1,1,1]}", "element 4 of \"RGBPoints\" is x = 0, not above the 0 before it"},
        {"{\"RGBPoints\":[5,0,0,0,-1,1,1,1]}", "is x = -1, not above the 5 before it"},
        {"{\"RGBPoints\":[0,0,0,0],\"Points\":[]}", "\"Points\" must be a list"},
        {"{\"RGBPoints\":[0,0,0,0],\"Points\":[0,0,0.5]}", "\"Points\" must be a list"},
        {"{\"RGBPoints\":[0,0,0,0],\"Points\":[0,0,0.5,-1]}", "element 3 of \"Points\" is -1, must be 0 to 1"},
        {"{\"RGBPoints\":[0,0,0,0],\"Points\":[1,0,0.5,0,1,0,0.5,0]}", "\"Points\" is x = 1, not above"},
        {"{\"ColorSpace\":\"Step\",\"RGBPoints\":[0,0,0,0]}", "\"ColorSpace\" must be"},
        {"{\"ColorSpace\":\"Lab/CIEDE2000\",\"RGBPoints\":[0,0,0,0]}", "\"ColorSpace\" must be"},
        {"{\"ColorSpace\":2,\"RGBPoints\":[0,0,0,0]}", "\"ColorSpace\" must be"},
        {"{\"HSVWrap\":\"yes\",\"RGBPoints\":[0,0,0,0]}", "\"HSVWrap\" must be"},
        {"{\"UseLogScale\":true,\"RGBPoints\":[1,0,0,0]}", "\"UseLogScale\" is not supported"},
        {"{\"IndexedColors\":[1,0,0]}", "\"IndexedColors\" is for categories"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        transfer t;
        host_error error;
        assert_int_equal(open_text(cases[i].text, &t, &error), HOST_BAD_INPUT);
        if (!strstr(error.text, cases[i].words) || strchr(error.text, '\n'))
            fail_msg("%s gave \"%s\"", cases[i].text, error.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_are_vtks),         cmocka_unit_test(opacities_are_vtks), cmocka_unit_test(defaults),
        cmocka_unit_test(tables_are_premultiplied), cmocka_unit_test(bad_files),
    };
    return cmocka_run_group_tests_name("paraview", tests, NULL, NULL);
}
