// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/document/lens_document.h"

#include "core/pipeline/lens/lens_comparison.h"

#include <QFileInfo>

#include <algorithm>
#include <utility>

namespace evical::ui {

LensDocument::LensDocument(CalibrationDocument& document, QObject* parent)
    : QObject(parent), document_(document) {
  connect(&document_, &CalibrationDocument::sessionReplaced, this, [this] {
    last_ = {};
    file_.reset();
    emit runChanged();
    emit othersChanged();
    if (std::exchange(had_session_, document_.hasSession()) && !document_.session().imus.empty())
      setAim(CalibrationAim::Rig);
  });
  connect(&document_, &CalibrationDocument::sessionChanged, this, &LensDocument::othersChanged);
}

void LensDocument::setAim(CalibrationAim aim) {
  if (aim == aim_) return;
  aim_ = aim;
  emit aimChanged();
}

std::size_t LensDocument::camera() const {
  const std::vector<SessionCamera>& cameras = document_.session().cameras;
  const auto found = std::find_if(cameras.begin(), cameras.end(), [this](const SessionCamera& camera) {
    return QString::fromStdString(camera.name) == camera_;
  });
  return found == cameras.end() ? 0 : static_cast<std::size_t>(found - cameras.begin());
}

void LensDocument::setCamera(const QString& name) {
  if (name == camera_) return;
  camera_ = name;
  emit aimChanged();
}

bool LensDocument::offersCameraOnly() const {
  const Session& session = document_.session();
  return aim_ == CalibrationAim::Rig && session.cameras.size() == 1 && session.imus.empty();
}

std::vector<SessionProblem> LensDocument::problems() const {
  return sessionProblems(document_.session(), aim_);
}

std::vector<SessionProblem> LensDocument::problemsOfCamera() const {
  return sessionProblems(document_.session(), CalibrationAim::Camera);
}

void LensDocument::addRun(LensRecord record) {
  last_ = std::move(record);
  emit runChanged();
}

bool LensDocument::runIsOutdated() const {
  if (!last_.run) return false;
  // Copying a lens into the session does not change its inputs.
  const auto without_lens = [this](Session session) {
    if (last_.camera < session.cameras.size()) {
      SessionCamera& camera = session.cameras[last_.camera];
      camera.intrinsics.reset();
      camera.intrinsics_uncertainty.reset();
      camera.resolution_px = {};
    }
    return sessionYaml(withoutRejectedWindows(std::move(session)), "/");
  };
  return without_lens(last_.session) != without_lens(document_.session());
}

std::vector<OtherLens> LensDocument::others() const {
  std::vector<OtherLens> others;
  if (last_.run && last_.camera < last_.session.cameras.size()) {
    const SessionCamera& camera = last_.session.sensor(last_.camera);
    if (camera.intrinsics)
      others.push_back(
          {tr("the session's previous lens"), {*camera.intrinsics, camera.intrinsics_uncertainty}});
  }
  if (file_) others.push_back(*file_);
  return others;
}

void LensDocument::loadOther(const QString& file) {
  if (!last_.run) return;
  const SessionCamera& camera = last_.session.cameras.at(last_.camera);
  OtherLens read{QFileInfo(file).fileName(),
                 readKnownIntrinsics(file.toStdString(), camera.name, camera.stream)};
  compareLenses(last_.run->result, read.lens);
  file_ = std::move(read);
  emit othersChanged();
}

// A camera on another camera's sensor shares its lens.
std::optional<std::size_t> LensDocument::cameraOfRun() const {
  if (!last_.run) return std::nullopt;
  const Session& session = document_.session();
  const std::string& name = last_.session.cameras.at(last_.camera).name;
  for (std::size_t k = 0; k < session.cameras.size(); ++k)
    if (session.cameras[k].name == name) return session.sensorOf(k);
  return std::nullopt;
}

void LensDocument::useInSession() {
  const std::optional<std::size_t> sensor = cameraOfRun();
  if (!sensor) return;
  Session changed = document_.session();
  SessionCamera& camera = changed.cameras[*sensor];
  camera.intrinsics = last_.run->result.intrinsics;
  camera.intrinsics_uncertainty.reset();
  camera.resolution_px = last_.run->result.intrinsics.resolution_px;
  document_.edit(changed, tr("Use the lens of %1").arg(QString::fromStdString(camera.name)));
}

bool LensDocument::isInSession() const {
  const std::optional<std::size_t> sensor = cameraOfRun();
  return sensor && document_.session().cameras[*sensor].intrinsics == last_.run->result.intrinsics;
}

}  // namespace evical::ui
