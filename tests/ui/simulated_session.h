// SPDX-License-Identifier: GPL-3.0-or-later
// Short recordings that are simulated once and shared by all tests of a build. Functions return session.yaml;
// recording.bag and truth.yaml are in the same folder. Do not write there.
#pragma once

#include <QString>

namespace evical::ui::test {

QString simulatedSession();           // 4 s of the standard scenario
QString simulatedHdSession();         // 3.5 s at 1280x720
QString simulatedTwoCameraSession();  // 4 s of two cameras, "left" and "right", 0.1 m apart, an IMU, each
                                      // With a camera in a separate bag.

// 6 s of the standard rig at other times and with other motions, by number; with the camera rotated on its
// mount.
QString simulatedFurtherSession(int number, double turned_deg = 0.0);

// A copy of the first session's file in `folder`, with the path of the shared recording.
QString copyOfSimulatedSession(const QString& folder);
// The same with a copy of the recording, for tests that damage it.
QString copyWithRecording(const QString& folder);

}  // namespace evical::ui::test
