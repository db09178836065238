// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/result_check_screen.h"

#include "ui/screens/assessment/finding_table.h"
#include "ui/screens/assessment/path_row.h"
#include "ui/screens/assessment/work_bar.h"

#include <QGridLayout>
#include <QListWidget>
#include <QVBoxLayout>

namespace evical::ui {

ResultCheckScreen::ResultCheckScreen(QWidget* parent)
    : AssessmentScreen(
          {"check_result", "check", tr("Is an old calibration still good?"), tr("Check"),
           tr("Calibrate the new recording, and test each quantity's change"),
           tr("Move the rig in front of the board for about ten seconds, as for a calibration, and "
              "choose that recording above. Evical calibrates the new recording and compares it with the "
              "old result. The verdict on each quantity is \"unchanged\", \"changed\", or \"cannot tell\" "
              "(the "
              "recording is too weak).")},
          parent),
      result_(new OldResultRow("old_result", grid(), this)),
      recording_(new PathRow("new_recording", tr("&New recording"),
                             tr("A recording of about ten seconds in front of the same board, or a session "
                                "for it.\n"
                                "Without a session, board and sensors of the old result are used."),
                             grid(), this)),
      table_(new FindingTable(this)) {
  constexpr int kNotes_px = 110;
  form().addLayout(&grid());
  addSaveButton(tr("Write check.yaml and the report to a folder"));
  notes()->setMaximumHeight(kNotes_px);
  auto* const content = new QWidget(this);
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(table_, 1);
  layout->addWidget(notes());
  setContent(content);
  connect(result_, &PathRow::changed, this, &ResultCheckScreen::offer);
  connect(recording_, &PathRow::changed, this, &ResultCheckScreen::offer);
  offer();
}

void ResultCheckScreen::setCheck(const CalibrationCheck& check) {
  showAssessment(check, {});
  table_->setFindings(check.findings);
  table_->setVisible(!check.findings.empty());
}

void ResultCheckScreen::offer() {
  work().setHindrance(result_->path().isEmpty()      ? tr("Choose the old result")
                      : recording_->path().isEmpty() ? tr("Choose the new recording")
                                                     : QString());
}

}  // namespace evical::ui
