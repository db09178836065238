// Sessions for the measurements of real cameras, IMUs and screens in the folder `real` of EVICAL_DATA, whose
// manifest lists the known values of each. Additional files of a session are written into `work`.
#pragma once

#include "core/data/calibration_state.h"
#include "core/pipeline/session/session.h"

#include <QDir>
#include <QString>

namespace evical::test {

// Empty if EVICAL_DATA is not set.
QString realRecordings();

// EuRoC's AprilGrid in front of its first camera and its IMU: raw corners of tags. They determine another
// lens than the data set's, whose principal point is some px away (docs/accuracy.md, "Known limits").
Session eurocImuApril(const QString& real, const QDir& work);
// The data set's pose of this camera: T_BS of cam0/sensor.yaml.
RigidTransform eurocImuFromCamera();
// RMS angle in deg between the rays of the data set's calibration and of `camera`, in the IMU's frame, in the
// middle of the image. Does not depend on how a shift of the principal point and a rotation share the
// difference.
double raysFromEuroc_deg(const CameraState& camera);
// An event camera's circles and a frame camera's corners, without an IMU; both lenses unknown. The size of
// the circles is unknown, so that their apparent displacement would bend a board that is free to bend.
Session efcalib(const QString& real, const QDir& work);
// A checkerboard on a flashing screen, in nine recordings of a DVS128.
Session dvs128Blinking(const QString& real, int rows, int cols);
// A printed checkerboard before a DVS128 moved by hand, of which most edges fire one event at a pixel.
// Between 8 and 35 s most of the board is in view.
Session dvs128Moving(const QString& real);
// Images of a checkerboard of 9 x 6 inner corners, without times.
Session pictures(const QDir& from, const QString& pattern, const QDir& work);

}  // namespace evical::test
