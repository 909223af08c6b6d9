/* exhaustive.h - tests of arithmetic in Verilog, on all operands. */
#ifndef TESTS_EXHAUSTIVE_H
#define TESTS_EXHAUSTIVE_H

void lockstep_lerp(void **state);
void lockstep_blend(void **state);

#endif
