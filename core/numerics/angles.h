// Degrees and radians: radians everywhere except in texts and files for users, which have degrees.
#pragma once

namespace evical {

// Written out, because Qt's moc cannot parse <numbers>.
inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;
inline constexpr double kDegPerRad = 180.0 / kPi;
inline constexpr double kRadPerDeg = kPi / 180.0;

}  // namespace evical
