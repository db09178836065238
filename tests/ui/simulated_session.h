// SPDX-License-Identifier: GPL-3.0-or-later
// A short recording that is simulated once and shared by all tests of a build.
#pragma once

#include <QString>

namespace evical::ui::test {

// session.yaml of 4 s of the everyday scenario; recording.bag and truth.yaml are beside it. Do not write
// there.
QString simulatedSession();

// A copy of the session file in `folder`, naming the shared recording.
QString copyOfSimulatedSession(const QString& folder);

}  // namespace evical::ui::test
