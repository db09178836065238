// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/follow_recording.h"

#include "ui/detection/detection_screen.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/window/workbench.h"

#include <algorithm>

namespace evical::ui {
namespace {

using Files = std::vector<std::filesystem::path>;

// The session's recording first.
Files filesOf(const Session& session) {
  Files files;
  const auto add = [&](const std::filesystem::path& file) {
    if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  };
  add(session.recording);
  for (const SessionCamera& camera : session.cameras) add(camera.recording);
  for (const SessionImu& imu : session.imus) {
    add(imu.recording);
    add(imu.accelerometer_recording);
  }
  return files;
}

// The recording is complete: streams, rates and pictures are read again.
void readAnew(const Pages& pages, Workbench& workbench) {
  QStringList recordings;
  for (const std::filesystem::path& file : filesOf(workbench.document.session()))
    recordings << QString::fromStdString(file.string());
  workbench.inspection.start(recordings);
  pages.detection->readAgain();
}

}  // namespace

void wireFollowing(const Pages& pages, Workbench& workbench) {
  GrowingRecording& growing = workbench.growing;
  RecordingCheckJob& check = workbench.check;
  const CalibrationDocument& document = workbench.document;
  RecordingScreen& screen = *pages.recording;
  CheckCard& card = *screen.checkCard();
  QObject::connect(&document, &CalibrationDocument::sessionChanged, &growing,
                   [&growing, &document, &card, &screen] {
                     growing.setFiles(document.hasSession() ? filesOf(document.session()) : Files{});
                     card.offerFollowing(growing.grown() || growing.following());
                     screen.setBeingWritten(growing.grown() || growing.following());
                   });
  QObject::connect(&growing, &GrowingRecording::growthNoticed, &card, [&card, &screen] {
    card.offerFollowing(true);
    screen.setBeingWritten(true);
  });
  QObject::connect(&card, &CheckCard::followingWanted, &growing, &GrowingRecording::setFollowing);
  // The summary has another wording while following.
  QObject::connect(&growing, &GrowingRecording::followingChanged, &card, [&card, &check](bool following) {
    card.setFollowing(following);
    if (const auto& checked = check.checked()) card.setAssessment(checked->assessment);
  });
  QObject::connect(&growing, &GrowingRecording::lookWanted, &check, &RecordingCheckJob::lookAgain);
  QObject::connect(&check, &RecordingCheckJob::started, &growing, &GrowingRecording::lookBegan);
  for (const auto ended : {&RecordingCheckJob::outdated, &RecordingCheckJob::interrupted})
    QObject::connect(&check, ended, &growing, &GrowingRecording::lookEnded);
  QObject::connect(&check, &RecordingCheckJob::checkedAnew, &growing, &GrowingRecording::lookEnded);
  QObject::connect(&check, &RecordingCheckJob::failed, &growing, &GrowingRecording::lookEnded);
  QObject::connect(&growing, &GrowingRecording::endReached, &screen, [pages, &workbench, &card, &screen] {
    card.offerFollowing(false);
    screen.setBeingWritten(false);
    readAnew(pages, workbench);
  });
}

}  // namespace evical::ui
