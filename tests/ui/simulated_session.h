// SPDX-License-Identifier: GPL-3.0-or-later
// Short recordings that are simulated once and shared by all tests of a build. session.yaml is returned;
// recording.bag and truth.yaml are beside it. Do not write there.
#pragma once

#include <QString>

namespace evical::ui::test {

QString simulatedSession();           // 4 s of the everyday scenario
QString simulatedHdSession();         // 3.5 s at 1280x720
QString simulatedTwoCameraSession();  // 4 s of two cameras, "left" and "right", 0.1 m apart, an IMU, each
                                      // camera in a bag of its own

// 6 s of the everyday rig at other moments and with other motions, by number; with the camera turned on its mount.
QString simulatedFurtherSession(int number, double turned_deg = 0.0);

// A copy of the first one's session file in `folder`, naming the shared recording.
QString copyOfSimulatedSession(const QString& folder);
// The same with a copy of the recording, for tests that spoil it.
QString copyWithRecording(const QString& folder);

}  // namespace evical::ui::test
