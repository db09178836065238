// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/ui/simulated_session.h"

#include "core/pipeline/session.h"
#include "core/pipeline/simulation.h"
#include "core/synthetic/scenario_yaml.h"

#include <QDir>
#include <QFile>
#include <QLockFile>

namespace evical::ui::test {

QString simulatedSession() {
  const QString folder = EVICAL_SIMULATED_FOLDER;
  QDir().mkpath(folder);
  QLockFile lock(folder + "/lock");
  lock.setStaleLockTime(0);
  lock.lock();
  const QString session = folder + "/recording/session.yaml";
  if (!QFile::exists(session)) {
    Scenario scenario = readScenario(EVICAL_SCENARIO);
    scenario.duration_s = 4.0;
    simulate(scenario, (folder + "/recording").toStdString(), RunContext{});
  }
  return session;
}

QString copyOfSimulatedSession(const QString& folder) {
  const QString copy = folder + "/session.yaml";
  writeSession(readSession(simulatedSession().toStdString()), copy.toStdString());
  return copy;
}

}  // namespace evical::ui::test
