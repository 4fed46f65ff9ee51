/* The least that starts a C program on an Arm MPS2 board with a Cortex-M4F (mps2-an386), as QEMU has it: everything is
 * loaded where it runs. Output and exit code go to the debugger (semihosting). */

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

extern unsigned char bss_begin[], bss_end[], stack_top[];
extern void initialise_monitor_handles(void);
extern int main(void);

void start(void);

void start(void) {
    *(volatile uint32_t *)0xe000ed88u |= 0xfu << 20; /* CPACR: floating point on */
    __asm volatile("dsb\n isb");
    memset(bss_begin, 0, (size_t)(bss_end - bss_begin));
    initialise_monitor_handles();
    exit(main());
}

/* A fault ends the run with an error instead of hanging it. */
static void fault(void) {
    abort();
}

__attribute__((section(".vectors"), used)) static const struct {
    void *stack;
    void (*handlers[6])(void);
} vectors = {stack_top, {start, fault, fault, fault, fault, fault}};
