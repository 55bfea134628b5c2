#pragma once

namespace elastogear::io {

/// Precision of stored numbers; in memory all are double.
enum class Precision { float64, float32 };

}  // namespace elastogear::io
