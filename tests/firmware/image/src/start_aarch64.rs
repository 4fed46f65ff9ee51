//! The first instructions on AArch64: floating point on, a stack, cleared .bss, then `main`. One core; the others sleep.
//! The alignment rules of memory before the MMU is on hold, since the target is built with strict alignment.

// SAFETY (of the assembly): runs once, first, on one core; the linker script gives the symbols, 16-byte aligned.
core::arch::global_asm!(
    r#"
.section .text.start, "ax"
.global _start
_start:
    mrs x0, mpidr_el1
    and x0, x0, #0xff
    cbnz x0, 3f
    mov x0, #(3 << 20)          // CPACR_EL1.FPEN: no trap on floating point
    msr cpacr_el1, x0
    isb
    ldr x0, =_stack_start
    mov sp, x0
    ldr x0, =_bss_start
    ldr x1, =_bss_end
1:  cmp x0, x1
    b.hs 2f
    stp xzr, xzr, [x0], #16
    b 1b
2:  bl main
3:  wfe
    b 3b
"#
);
