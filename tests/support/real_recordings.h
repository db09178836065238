// Sessions for the measurements of real cameras, IMUs and screens in the folder `real` of EVICAL_DATA, whose manifest tells
// what is known of each. Files that a session needs beside them are written into `work`.
#pragma once

#include "core/pipeline/session/session.h"

#include <QDir>
#include <QString>

namespace evical::test {

// Empty where EVICAL_DATA is not set.
QString realRecordings();

// EuRoC's AprilGrid before its first camera and its IMU: raw corners of tags, which bend a lens that is free by 5 px.
Session eurocImuApril(const QString& real, const QDir& work);
// An event camera's circles and a frame camera's corners, without an IMU; both lenses unknown. How large its circles are
// is not known, so that what they seem displaced by would bend a board that is free to be bent.
Session efcalib(const QString& real, const QDir& work);
// A checkerboard on a screen that flashes, in nine recordings of a DVS128.
Session dvs128Blinking(const QString& real, int rows, int cols);
// Pictures of a checkerboard of 9 x 6 inner corners, without times.
Session pictures(const QDir& from, const QString& pattern, const QDir& work);

}  // namespace evical::test
