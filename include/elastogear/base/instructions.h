#pragma once
// Which vector instructions a kernel may use, chosen at run time.

namespace elastogear {

/// Instruction sets of the processor that kernels are compiled for.
enum class Instructions { portable, avx2, avx512 };

/// The best that this processor has.
Instructions best_instructions();

}  // namespace elastogear
