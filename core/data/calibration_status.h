// Whether what was calibrated can be relied on.
#pragma once

namespace evical {

enum class CalibrationStatus { Ok, Doubtful, Failed };

}  // namespace evical
