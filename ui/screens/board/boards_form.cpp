// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/boards_form.h"

#include "core/base/error.h"
#include "core/pipeline/session/session_boards.h"
#include "ui/forms/form_words.h"
#include "ui/screens/board/board_form.h"
#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QTabBar>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <set>

namespace evical::ui {
namespace {

bool isOf(const QString& field, const QString& key) {
  return field == key || field.startsWith(key + ".");
}

// Index of the new board, or of the previously chosen one after a change of the list.
std::size_t chosenAfter(const std::vector<std::string>& before, const std::vector<std::string>& after,
                        std::size_t chosen) {
  const auto among = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name);
  };
  const auto isNew = [&](const std::string& name) { return among(before, name) == before.end(); };
  const auto added = std::find_if(after.begin(), after.end(), isNew);
  if (after.size() == before.size() + 1 && added != after.end())
    return static_cast<std::size_t>(added - after.begin());
  const auto kept = among(after, before.at(chosen));
  if (kept != after.end()) return static_cast<std::size_t>(kept - after.begin());
  return std::min(chosen, after.size() - 1);
}

}  // namespace

BoardsForm::BoardsForm(QWidget* parent)
    : QWidget(parent), chooser_(new BoardChooser(this)), form_(new BoardForm(this)) {
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(form_, 1);
  connect(form_, &BoardForm::blinkingChosen, this, &BoardsForm::setBlinking);
  connect(chooser_, &BoardChooser::chosen, this, &BoardsForm::choose);
  connect(chooser_, &BoardChooser::addRequested, this, &BoardsForm::add);
  connect(chooser_, &BoardChooser::removeRequested, this, &BoardsForm::remove);
  connect(form_, &BoardForm::renamed, this, &BoardsForm::rename);
  connect(form_, &BoardForm::edited, this, [this](const Board& board, const QString& field) {
    Session changed = session_;
    setBoardAt(chosen_, board, changed);
    emit sessionEdited(changed, what(tr("Change the board"), tr("Change board %1")), mergeKey(field));
  });
  connect(form_, &BoardForm::measured, this,
          [this](const std::optional<MeasuredLength>& measured, const QString& field) {
            Session changed = session_;
            setMeasuredAt(chosen_, measured, changed);
            emit sessionEdited(changed, what(tr("Measure the board"), tr("Measure board %1")),
                               mergeKey(field));
          });
  showChosen();
}

QWidget* BoardsForm::chooser() const {
  return chooser_;
}

void BoardsForm::setSession(const Session& session) {
  const bool other = session.recording != session_.recording;
  chosen_ = other ? 0 : chosenAfter(boardNames(session_), boardNames(session), chosen_);
  session_ = session;
  showChosen();
  if (other) form_->foldMore();
}

void BoardsForm::showChosen() {
  QStringList names;
  for (const std::string& name : boardNames(session_)) names << QString::fromStdString(name);
  const auto chosen = static_cast<qsizetype>(chosen_);
  chooser_->setBoards(names, chosen_);
  chooser_->setFull(session_.board_blinks ? tr("A flashing board must be the only one")
                    : static_cast<std::size_t>(names.size()) >= session_.cameras.size()
                        ? tr("Each camera sees one board, so there cannot be more boards than cameras")
                        : QString());
  form_->setBoard(boardAt(session_, chosen_), measuredAt(session_, chosen_));
  form_->setBlinking(session_.further_boards.empty() && session_.board.hasPattern(), session_.board_blinks);
  form_->setName(names.size() > 1 ? names[chosen] : QString(), seenBy());
}

QString BoardsForm::seenBy() const {
  QStringList cameras;
  for (std::size_t k = 0; k < session_.cameras.size(); ++k)
    if (session_.boardIndexOf(k) == chosen_) cameras << QString::fromStdString(session_.cameras[k].name);
  return cameras.isEmpty() ? tr("no camera yet") : cameras.join(", ");
}

void BoardsForm::setProblems(const std::vector<std::pair<QString, QString>>& field_and_text) {
  const std::vector<std::string> names = boardNames(session_);
  QStringList texts;
  std::set<std::size_t> wrong;
  for (const auto& [field, text] : field_and_text) {
    if (!isOfBoards(field)) continue;
    QString said = text;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!isOf(field, QString::fromStdString(boardKey(session_, i)))) continue;
      wrong.insert(i);
      if (names.size() > 1) said = QString::fromStdString(names[i]) + ": " + text;
    }
    texts << said;
  }
  chooser_->setWrong(wrong);
  form_->setProblem(inFormWords(texts.join('\n')));
}

// Only a flashing board may have several recordings, one for each of its poses.
void BoardsForm::setBlinking(bool blinking) {
  Session changed = session_;
  changed.board_blinks = blinking;
  if (!blinking) changed.more_recordings.clear();
  emit sessionEdited(changed, blinking ? tr("Mark the board as flashing") : tr("Mark the board as printed"),
                     {});
}

void BoardsForm::choose(std::size_t index) {
  chosen_ = std::min(index, session_.further_boards.size());
  showChosen();
}

void BoardsForm::add() {
  Session changed = session_;
  addBoard(chosen_, changed);
  emit sessionEdited(changed, tr("Add a board"), {});
}

void BoardsForm::remove() {
  Session changed = session_;
  removeBoard(chosen_, changed);
  emit sessionEdited(changed, what({}, tr("Remove board %1")), {});
}

void BoardsForm::rename(const QString& name) {
  Session changed = session_;
  try {
    renameBoard(chosen_, name.toStdString(), changed);
  } catch (const CalibrationError& error) {
    return form_->setNameProblem(QString::fromStdString(error.problem() + ". " + error.advice()));
  }
  emit sessionEdited(changed, what({}, tr("Rename board %1")), {});
}

QString BoardsForm::what(const QString& of_one, const QString& of_several) const {
  if (session_.further_boards.empty()) return of_one;
  return of_several.arg(QString::fromStdString(boardNames(session_).at(chosen_)));
}

QString BoardsForm::mergeKey(const QString& field) const {
  return QString::fromStdString(boardKey(session_, chosen_)) + "." + field;
}

namespace {

// Takes the focus when clicked, so that a field commits its text before the click acts.
QToolButton* toolButton(const char* icon_name, const QString& tip, QWidget* parent) {
  auto* const made = new QToolButton(parent);
  made->setIcon(icon(icon_name));
  made->setFocusPolicy(Qt::StrongFocus);
  made->setToolTip(tip);
  made->setAccessibleName(tip);
  return made;
}

QString addTip() {
  return BoardChooser::tr(
      "Adds a board for cameras that see a different one; it starts as a copy of this board");
}

}  // namespace

BoardChooser::BoardChooser(QWidget* parent)
    : QWidget(parent),
      tabs_(new QTabBar(this)),
      add_(toolButton("add", addTip(), this)),
      remove_(toolButton("remove", tr("Remove this board; its cameras then use the first board"), this)) {
  tabs_->setObjectName("boards");
  add_->setObjectName("add_board");
  remove_->setObjectName("remove_board");
  tabs_->setFocusPolicy(Qt::StrongFocus);
  tabs_->setExpanding(false);
  tabs_->setDrawBase(false);
  tabs_->setElideMode(Qt::ElideRight);
  tabs_->setUsesScrollButtons(true);
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(2);
  row->addWidget(tabs_, 1);
  row->addStretch();
  row->addWidget(add_);
  row->addWidget(remove_);
  connect(tabs_, &QTabBar::currentChanged, this,
          [this](int index) { emit chosen(static_cast<std::size_t>(index)); });
  connect(add_, &QToolButton::clicked, this, &BoardChooser::addRequested);
  connect(remove_, &QToolButton::clicked, this, &BoardChooser::removeRequested);
}

// Tabs are reused: a click on one may interrupt an edit.
void BoardChooser::setBoards(const QStringList& names, std::size_t chosen) {
  const QSignalBlocker quiet(tabs_);
  while (tabs_->count() > names.size()) tabs_->removeTab(tabs_->count() - 1);
  while (tabs_->count() < names.size()) tabs_->addTab(icon("board"), {});
  for (int i = 0; i < tabs_->count(); ++i) {
    tabs_->setTabText(i, QString(names[i]).replace('&', "&&"));
    tabs_->setTabToolTip(i, i == 0 ? tr("%1: its frame is the world frame").arg(names[i]) : names[i]);
  }
  tabs_->setCurrentIndex(static_cast<int>(chosen));
  tabs_->setVisible(names.size() > 1);
  remove_->setVisible(names.size() > 1);
}

void BoardChooser::setWrong(const std::set<std::size_t>& wrong) {
  for (int i = 0; i < tabs_->count(); ++i)
    tabs_->setTabIcon(i, icon(wrong.contains(static_cast<std::size_t>(i)) ? "warning" : "board"));
}

void BoardChooser::setFull(const QString& why) {
  add_->setEnabled(why.isEmpty());
  add_->setToolTip(why.isEmpty() ? addTip() : why);
}

}  // namespace evical::ui
