// Radians everywhere except in text and files for people, who get degrees.
#pragma once

namespace evical {

// Written out, because Qt's moc cannot parse <numbers>.
inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;
inline constexpr double kDegPerRad = 180.0 / kPi;
inline constexpr double kRadPerDeg = kPi / 180.0;

}  // namespace evical
