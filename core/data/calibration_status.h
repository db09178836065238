// Status of a calibration: whether the result is reliable.
#pragma once

namespace evical {

enum class CalibrationStatus { Ok, Doubtful, Failed };

}  // namespace evical
