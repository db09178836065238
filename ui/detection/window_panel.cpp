// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_panel.h"

#include "ui/detection/timeline.h"
#include "ui/detection/window_analysis.h"
#include "ui/detection/window_list_model.h"
#include "ui/theme/theme.h"

#include <QScrollBar>
#include <QTextDocument>

#include <algorithm>

namespace evical::ui {
namespace {

QString coloured(const QColor& colour, const QString& text) {
  return QStringLiteral("<span style='color:%1'>%2</span>").arg(colour.name(), text);
}

QColor colourOf(StageVerdict verdict) {
  switch (verdict) {
    case StageVerdict::Passed:
      return theme().good;
    case StageVerdict::Failed:
      return theme().bad;
    case StageVerdict::NotReached:
    case StageVerdict::Note:
      break;
  }
  return theme().faint_text;
}

// Shapes, for readers who cannot distinguish the colours.
QString markOf(StageVerdict verdict) {
  switch (verdict) {
    case StageVerdict::Passed:
      return QStringLiteral("\u2713");
    case StageVerdict::Failed:
      return QStringLiteral("\u2717");
    case StageVerdict::NotReached:
      return QStringLiteral("\u25cb");
    case StageVerdict::Note:
      break;
  }
  return QStringLiteral("\u2022");
}

QString capital(QString word) {
  if (!word.isEmpty()) word[0] = word[0].toUpper();
  return word;
}

QString timeText(const WindowAnalysis& analysis) {
  const QString time = WindowPanel::tr("%1 s").arg(analysis.time_s, 0, 'f', 4);
  if (analysis.frame) return time;
  return time + WindowPanel::tr(" ± %1 ms").arg(1e3 * analysis.half_width_s, 0, 'f', 1);
}

QString headline(const WindowAnalysis& analysis, bool searching) {
  const QString words = searching && !analysis.held()
                            ? WindowPanel::tr("Searching ...")
                            : capital(windowOutcomeWords(analysis.outcome, analysis.frame.has_value()));
  const QColor colour =
      searching && !analysis.held() ? theme().faint_text : windowColour(windowClass(analysis.outcome));
  return QStringLiteral("<p style='margin:0; font-size:large'><b>%1</b></p><p style='margin:0'>%2</p>")
      .arg(coloured(colour, words), coloured(theme().faint_text, timeText(analysis)));
}

// Last failed stage, at the top.
QString lostLine(const WindowAnalysis& analysis) {
  if (windowClass(analysis.outcome) != WindowClass::Missed) return {};
  const auto lost =
      std::find_if(analysis.stages.rbegin(), analysis.stages.rend(),
                   [](const StageReport& stage) { return stage.verdict == StageVerdict::Failed; });
  if (lost == analysis.stages.rend()) return {};
  return QStringLiteral("<p style='margin:4px 0 0 0'>%1</p>")
      .arg(WindowPanel::tr("Failed at %1: %2")
               .arg(QStringLiteral("<b>%1</b>").arg(QString::fromStdString(lost->stage)),
                    QString::fromStdString(lost->text).toHtmlEscaped()));
}

QString stageRow(const StageReport& stage) {
  const bool faint = stage.verdict == StageVerdict::NotReached || stage.verdict == StageVerdict::Note;
  const QString text = QString::fromStdString(stage.text).toHtmlEscaped();
  return QStringLiteral(
             "<tr><td style='padding-right:6px'>%1</td><td "
             "style='padding-bottom:5px'><b>%2</b><br>%3</td></tr>")
      .arg(coloured(colourOf(stage.verdict), markOf(stage.verdict)),
           capital(QString::fromStdString(stage.stage)).toHtmlEscaped(),
           faint ? coloured(theme().faint_text, text) : text);
}

// If a window was missed before and now, only the present reason is shown: it is analysed with the current
// options, while the run had lenses and previous views that may be missing here.
QString passLine(const WindowReport& report, bool of_frame, bool missed_now) {
  if (missed_now && windowClass(report.outcome) == WindowClass::Missed)
    return WindowPanel::tr("Also missed in the last run");
  const QString found = WindowPanel::tr(", %1 points%2");
  const QString how =
      report.circles > 0
          ? found.arg(report.circles).arg(report.tracked ? WindowPanel::tr(", tracked") : QString())
          : QString();
  return WindowPanel::tr("In the last run: %1%2").arg(windowOutcomeWords(report.outcome, of_frame), how);
}

}  // namespace

// One text layout for the panel: labels of rich text in a scroll area would need four.
WindowPanel::WindowPanel(QWidget* parent) : QTextBrowser(parent) {
  constexpr double kMargin_px = 8.0;
  document()->setDocumentMargin(kMargin_px);
  viewport()->setAutoFillBackground(false);
  setUndoRedoEnabled(false);
  setOpenLinks(false);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setAccessibleName(tr("Outcome of this event window"));
}

void WindowPanel::show(const WindowAnalysis* analysis, const std::optional<WindowReport>& report,
                       bool searching) {
  QString html;
  if (analysis) {
    html = headline(*analysis, searching);
    const bool missed = !searching && windowClass(analysis->outcome) == WindowClass::Missed;
    if (report)
      html += QStringLiteral("<p style='margin:0'>%1</p>")
                  .arg(coloured(theme().faint_text, passLine(*report, analysis->frame.has_value(), missed)));
    if (!searching) html += lostLine(*analysis);
    html += QStringLiteral("<table style='margin-top:8px'>");
    for (const StageReport& stage : analysis->stages) html += stageRow(stage);
    html += QStringLiteral("</table>");
    if (analysis->took_s > 0.0)
      html += coloured(theme().faint_text, tr("Computed in %1 ms").arg(1e3 * analysis->took_s, 0, 'f', 0));
  } else {
    html = coloured(theme().faint_text,
                    tr("The front end's stages for the event window at the cursor are shown here."));
  }
  if (html == html_) return;
  html_ = html;
  const int scrolled = verticalScrollBar()->value();
  setHtml(html);
  verticalScrollBar()->setValue(scrolled);
}

QString WindowPanel::text() const {
  return toPlainText();
}

}  // namespace evical::ui
