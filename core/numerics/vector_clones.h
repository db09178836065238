// For functions that are mostly one loop over numbers: compiled a second time for processors of the last ten years, and
// chosen when the program starts. Sums then differ from those of older processors in the last digit.
#pragma once

// Sanitizers are not ready yet when that choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVICAL_VECTOR_CLONES __attribute__((target_clones("arch=haswell", "default")))
#else
#define EVICAL_VECTOR_CLONES
#endif
