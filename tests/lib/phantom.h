/* phantom.h - made-up CT volumes: smooth tissues with sharp borders, as pictures are judged on. */
#ifndef TESTS_PHANTOM_H
#define TESTS_PHANTOM_H

#include "volume.h"

enum { PHANTOM_VOX = 72 }; /* along each axis */

/* "head": an egg of skin, skull and brain; "vessels": a tube wound round another. Fills *v as the reader of an int16
 * file in Hounsfield units would, to be closed by volume_close(). False when the host is out of memory. */
bool phantom_open(const char *name, volume *v);

#endif
