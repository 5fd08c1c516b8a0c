#include "libtcs_preload/cycle_counter/entries.h"

#include <cstdint>

#include "libtcs_preload/cycle_counter/virtual_counter.h"
#include "libtcs_preload/spinning/pauses.h"

// Functions that use general registers only are asked first; most reads end there. Functions that
// may wait for a turn use the low halves of vectors, too, as code for every x86-64 does.
//
// Flags are kept by lahf and seto, which cost less than pushf and popf. `add` gets the overflow
// flag back, sahf the others.
#define TCS_SAVE                                                                       \
  "pushq %rcx\n\tpushq %rsi\n\tpushq %rdi\n\tpushq %r8\n\tpushq %r9\n\tpushq %r10\n\t" \
  "pushq %r11\n\tpushq %rbp\n\t"                                                       \
  "lahf\n\tseto %al\n\tpushq %rax\n\t"                                                 \
  "movq %rsp, %rbp\n\tandq $-16, %rsp\n\t"
#define TCS_READ                    \
  "call tcs_counter_at_once\n\t"    \
  "testq %rax, %rax\n\tjnz 1f\n\t"  \
  "call tcs_counter_with_vectors\n" \
  "1:\n\t"
#define TCS_GIVE_FLAGS "popq %rax\n\taddb $0x7f, %al\n\tsahf\n\t"
#define TCS_GIVE_REGISTERS                                                       \
  "popq %rbp\n\tpopq %r11\n\tpopq %r10\n\tpopq %r9\n\tpopq %r8\n\tpopq %rdi\n\t" \
  "popq %rsi\n\tpopq %rcx\n\t"
#define TCS_RESTORE                                                         \
  "movq %rbp, %rsp\n\t"                                                     \
  "movq %rax, %rdx\n\tshrq $32, %rdx\n\tmovl %eax, %esi\n\t" TCS_GIVE_FLAGS \
  "movl %esi, %eax\n\t" TCS_GIVE_REGISTERS "ret\n\t"

#define TCS_VECTORS(move)                                                                  \
  move(0) move(1) move(2) move(3) move(4) move(5) move(6) move(7) move(8) move(9) move(10) \
      move(11) move(12) move(13) move(14) move(15)
#define TCS_KEEP_VECTOR(i) "movups %xmm" #i ", 16*" #i "(%rsp)\n\t"
#define TCS_GIVE_VECTOR(i) "movups 16*" #i "(%rsp), %xmm" #i "\n\t"

__asm__(
    ".text\n\t.p2align 4\n\t"
    ".hidden tcs_read_counter\n\t.globl tcs_read_counter\n\t"
    ".type tcs_read_counter, @function\n"
    "tcs_read_counter:\n\tendbr64\n\t" TCS_SAVE TCS_READ TCS_RESTORE
    ".size tcs_read_counter, .-tcs_read_counter\n\t"

    ".p2align 4\n\t"
    ".hidden tcs_read_counter_and_processor\n\t.globl tcs_read_counter_and_processor\n\t"
    ".type tcs_read_counter_and_processor, @function\n"
    "tcs_read_counter_and_processor:\n\tendbr64\n\t" TCS_SAVE TCS_READ
    "movq %rax, 64(%rbp)\n\t"  // where rcx is, until that has its new value
    "call tcs_counter_processor\n\t"
    "movq 64(%rbp), %rdx\n\tmovl %eax, %eax\n\tmovq %rax, 64(%rbp)\n\tmovq %rdx, %rax\n\t"
    TCS_RESTORE
    ".size tcs_read_counter_and_processor, .-tcs_read_counter_and_processor\n\t"

    ".p2align 4\n\t"
    ".hidden tcs_pause\n\t.globl tcs_pause\n\t"
    ".type tcs_pause, @function\n"
    "tcs_pause:\n\tendbr64\n\tpushq %rax\n\tpushq %rdx\n\t" TCS_SAVE
    "movq 88(%rbp), %rdi\n\t"  // where the program goes on
    "call tcs_pause_at_once\n\ttestl %eax, %eax\n\tjnz 1f\n\t"
    "subq $256, %rsp\n\t" TCS_VECTORS(TCS_KEEP_VECTOR)
    "movq 88(%rbp), %rdi\n\t"
    "call tcs_pause_in_turn\n\t" TCS_VECTORS(TCS_GIVE_VECTOR)
    "1:\n\tmovq %rbp, %rsp\n\t"
    TCS_GIVE_FLAGS TCS_GIVE_REGISTERS "popq %rdx\n\tpopq %rax\n\tret\n\t"
    ".size tcs_pause, .-tcs_pause\n\t"

    ".p2align 4\n\t"
    ".type tcs_counter_with_vectors, @function\n"
    "tcs_counter_with_vectors:\n\t"
    "subq $264, %rsp\n\t" TCS_VECTORS(TCS_KEEP_VECTOR)
    "call tcs_counter_in_turn\n\t" TCS_VECTORS(TCS_GIVE_VECTOR)
    "addq $264, %rsp\n\tret\n\t"
    ".size tcs_counter_with_vectors, .-tcs_counter_with_vectors\n\t");
