/* device_no_cuda.c - in the place of device_cuda.cu where make finds no nvcc. */
#include "device.h"

const device_ops *device_cuda(void)
{
    return NULL;
}
