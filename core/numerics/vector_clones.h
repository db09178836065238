// Function attribute for tight numerical loops: a second version is compiled for processors of the last ten
// years, and selected at program start. Sums of the two versions differ in the last digit.
#pragma once

// Not with sanitizers: the selection runs before they are initialised.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVICAL_VECTOR_CLONES __attribute__((target_clones("arch=haswell", "default")))
#else
#define EVICAL_VECTOR_CLONES
#endif
