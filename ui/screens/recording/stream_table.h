// SPDX-License-Identifier: GPL-3.0-or-later
// Streams of a recording, their content, and their roles.
#pragma once

#include "core/pipeline/session/session.h"
#include "core/recording/inspection.h"

#include <QTableWidget>

#include <filesystem>
#include <vector>

class QComboBox;

namespace evical::ui {

enum class StreamRole { Ignore, Camera, Imu };

class StreamTable : public QTableWidget {
  Q_OBJECT

 public:
  explicit StreamTable(QWidget* parent = nullptr);

  void clearStreams();
  // `own_recording`: the file if it is not the session's. Its streams are appended.
  void addInspection(const Inspection& inspection, const std::filesystem::path& own_recording = {});
  void setSession(const Session& session);  // the roles
  StreamRole role(int row) const;

 signals:
  void roleChosen(int row, evical::ui::StreamRole role);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void addStream(const StreamSummary& stream, const std::vector<RecordingFault>& faults,
                 const std::filesystem::path& own_recording);
  void addFaults(int row, const StreamSummary& stream, const std::vector<RecordingFault>& faults);
  void fitHeight();
  void showIcons();
  QComboBox* roleBoxOf(int row) const;
};

}  // namespace evical::ui
