// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_list_model.h"

#include "ui/detection/window_pictures.h"

#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::ui {
namespace {

std::vector<double> rmsOfViews_px(const CalibrationRun& run, std::size_t camera) {
  const std::size_t views = run.detections.cameras[camera].views.size();
  std::vector<double> squares(views, 0.0), rms_px(views, std::numeric_limits<double>::quiet_NaN());
  std::vector<int> counts(views, 0);
  for (const CircleResidual& residual : run.result.circle_residuals) {
    const auto view = static_cast<std::size_t>(residual.view);
    if (!residual.used || residual.camera != static_cast<int>(camera) || view >= views) continue;
    squares[view] += residual.residual_px.squaredNorm();
    ++counts[view];
  }
  for (std::size_t view = 0; view < views; ++view)
    if (counts[view] > 0) rms_px[view] = std::sqrt(squares[view] / counts[view]);
  return rms_px;
}

double speedOf_px_s(const BoardView& view) {
  std::vector<double> speeds;
  for (const CircleObservation& circle : view.circles) speeds.push_back(circle.velocity_px_s.norm());
  return medianOf(std::move(speeds), std::numeric_limits<double>::quiet_NaN());
}

// Row with the same middle; null if there is none.
WindowRow* rowOf(const BoardView& view, std::vector<WindowRow>& rows) {
  const auto row =
      std::lower_bound(rows.begin(), rows.end(), view.time_s,
                       [](const WindowRow& each, double time_s) { return each.report.time_s < time_s; });
  return row != rows.end() && row->report.time_s == view.time_s ? &*row : nullptr;
}

void addView(const BoardView& view, double rms_px, std::vector<WindowRow>& rows) {
  WindowRow* const row = rowOf(view, rows);
  if (row == nullptr) return;
  row->has_view = true;
  row->found = view.kind == ViewKind::Complete ? WindowOutcome::Complete : WindowOutcome::Partial;
  row->rms_px = rms_px;
  row->speed_px_s = speedOf_px_s(view);
}

}  // namespace

std::vector<WindowRow> windowRows(const CalibrationRun& run, std::size_t camera) {
  const BoardObservations& seen = run.detections.cameras.at(camera);
  std::vector<WindowRow> rows;
  rows.reserve(seen.windows.size());
  for (const WindowReport& report : seen.windows) rows.push_back({report, report.outcome});
  const std::vector<double> rms_px = rmsOfViews_px(run, camera);
  for (std::size_t k = 0; k < seen.views.size(); ++k) addView(seen.views[k], rms_px[k], rows);
  if (camera < run.detections.rejected_views.size())
    for (const BoardView& view : run.detections.rejected_views[camera])
      addView(view, std::numeric_limits<double>::quiet_NaN(), rows);
  return rows;
}

std::optional<double> middleOfSeen_s(const std::vector<WindowReport>& windows) {
  if (windows.empty()) return std::nullopt;
  const double middle_s = 0.5 * (windows.front().time_s + windows.back().time_s);
  for (const WindowOutcome wanted : {WindowOutcome::Complete, WindowOutcome::Partial}) {
    std::optional<double> nearest_s;
    for (const WindowReport& window : windows)
      if (window.outcome == wanted &&
          (!nearest_s || std::abs(window.time_s - middle_s) < std::abs(*nearest_s - middle_s)))
        nearest_s = window.time_s;
    if (nearest_s) return nearest_s;
  }
  return std::nullopt;
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

constexpr double kShareOfWorst = 0.1;

QString numberOrDash(double value, int decimals) {
  return std::isfinite(value) ? QString::number(value, 'f', decimals) : QStringLiteral("\u2013");
}

// Smallest RMS of the worst windows; infinite if none has an RMS.
double worstFrom(const std::vector<WindowRow>& rows) {
  std::vector<double> rms_px;
  for (const WindowRow& row : rows)
    if (std::isfinite(row.rms_px)) rms_px.push_back(row.rms_px);
  if (rms_px.empty()) return std::numeric_limits<double>::infinity();
  const auto count = static_cast<long>(std::ceil(kShareOfWorst * static_cast<double>(rms_px.size())));
  const auto least = rms_px.begin() + (count - 1);
  std::nth_element(rms_px.begin(), least, rms_px.end(), std::greater<>());
  return *least;
}

}  // namespace

QString windowClassName(WindowClass window_class) {
  switch (window_class) {
    case WindowClass::Complete:
      return WindowListModel::tr("Complete");
    case WindowClass::Partial:
      return WindowListModel::tr("Partial");
    case WindowClass::Rejected:
      return WindowListModel::tr("Rejected");
    case WindowClass::Missed:
      break;
  }
  return WindowListModel::tr("Missed");
}

QString windowOutcomeWords(WindowOutcome outcome, bool of_frame) {
  if (of_frame && outcome == WindowOutcome::NoLattice) return WindowListModel::tr("no board found");
  if (of_frame && outcome == WindowOutcome::TooFewInGrid) return WindowListModel::tr("too few points");
  return QString::fromUtf8(windowOutcomeName(outcome));
}

WindowListModel::WindowListModel(const WindowPictures& pictures, QObject* parent)
    : QAbstractTableModel(parent), pictures_(pictures) {}

void WindowListModel::setWindows(std::vector<WindowRow> rows, CameraKind kind) {
  beginResetModel();
  rows_ = std::move(rows);
  kind_ = kind;
  worst_from_px_ = worstFrom(rows_);
  endResetModel();
}

void WindowListModel::setRejected(std::vector<double> times_s) {
  if (times_s == rejected_s_) return;
  rejected_s_ = std::move(times_s);
  if (!rows_.empty()) emit dataChanged(index(0, State), index(rowCount() - 1, State));
}

void WindowListModel::pictureWasMade(int row) {
  if (row < rowCount()) emit dataChanged(index(row, Picture), index(row, Picture), {Qt::DecorationRole});
}

// Windows without a view keep their state of the run.
bool WindowListModel::isRejected(int row) const {
  const WindowRow& each = window(row);
  if (!each.has_view) return each.report.outcome == WindowOutcome::RejectedByHand;
  return std::binary_search(rejected_s_.begin(), rejected_s_.end(), each.report.time_s);
}

bool WindowListModel::isPending(int row) const {
  return isRejected(row) != (window(row).report.outcome == WindowOutcome::RejectedByHand);
}

WindowClass WindowListModel::classOf(int row) const {
  return isRejected(row) ? WindowClass::Rejected : windowClass(window(row).found);
}

QString WindowListModel::secondLine(int row) const {
  if (isPending(row)) return isRejected(row) ? tr("in the next run") : tr("included in the next run");
  if (classOf(row) == WindowClass::Missed)
    return windowOutcomeWords(window(row).report.outcome, kind_ == CameraKind::Frames);
  if (classOf(row) == WindowClass::Rejected) return tr("by hand");
  return {};
}

std::optional<int> WindowListModel::rowAt(double time_s) const {
  const auto later =
      std::lower_bound(rows_.begin(), rows_.end(), time_s,
                       [](const WindowRow& row, double at_s) { return row.report.time_s < at_s; });
  std::optional<int> nearest;
  double distance_s = std::numeric_limits<double>::infinity();
  const auto consider = [&](auto row) {
    const double away_s = std::abs(row->report.time_s - time_s);
    if (away_s > row->report.half_width_s + 1e-9 || away_s >= distance_s) return;
    distance_s = away_s;
    nearest = static_cast<int>(row - rows_.begin());
  };
  if (later != rows_.end()) consider(later);
  if (later != rows_.begin()) consider(std::prev(later));
  return nearest;
}

int WindowListModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int WindowListModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : ColumnCount;
}

QString WindowListModel::textOf(int row, int column) const {
  const WindowRow& each = window(row);
  switch (column) {
    case Time:
      return QString::number(each.report.time_s, 'f', 3);
    case State:
      return windowClassName(classOf(row));
    case Circles:
      return QString::number(each.report.circles);
    case Rms:
      return numberOrDash(each.rms_px, 3);
    case Speed:
      return numberOrDash(each.speed_px_s, 0);
    default:
      return {};
  }
}

// Unknown values come first.
QVariant WindowListModel::sortKeyOf(int row, int column) const {
  const WindowRow& each = window(row);
  const auto known = [](double value) { return std::isfinite(value) ? value : -1.0; };
  switch (column) {
    case State:
      return 100 * static_cast<int>(classOf(row)) + static_cast<int>(each.report.outcome);
    case Circles:
      return each.report.circles;
    case Rms:
      return known(each.rms_px);
    case Speed:
      return known(each.speed_px_s);
    default:
      return each.report.time_s;
  }
}

QString WindowListModel::helpOf(int row) const {
  const WindowRow& each = window(row);
  const QString second = secondLine(row);
  QString help = tr("%1 s: %2").arg(textOf(row, Time), textOf(row, State).toLower());
  if (!second.isEmpty()) help += QStringLiteral(", ") + second;
  help += tr("\n%1 points").arg(each.report.circles);
  if (std::isfinite(each.rms_px)) help += tr(", RMS %1 px").arg(textOf(row, Rms));
  if (std::isfinite(each.speed_px_s)) help += tr(", %1 px/s").arg(textOf(row, Speed));
  return help;
}

QVariant WindowListModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  switch (role) {
    case Qt::DisplayRole:
      return textOf(index.row(), index.column());
    case Qt::DecorationRole: {
      if (index.column() != Picture) return {};
      const QPixmap* const picture = pictures_.of(index.row());
      return picture != nullptr ? QVariant(*picture) : QVariant();
    }
    case Qt::ToolTipRole:
    case Qt::AccessibleTextRole:
      return helpOf(index.row());
    case Qt::TextAlignmentRole:
      return QVariant(Qt::AlignVCenter | (index.column() == State ? Qt::AlignLeft : Qt::AlignRight));
    case kSortRole:
      return sortKeyOf(index.row(), index.column());
    case kSecondLineRole:
      return index.column() == State ? secondLine(index.row()) : QString();
    default:
      return {};
  }
}

QVariant WindowListModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section >= ColumnCount) return {};
  const QString titles[] = {{}, tr("s"), tr("State"), tr("Points"), tr("RMS px"), tr("px/s")};
  const QString helps[] = {
      tr("Events of the window, or the frame"),
      tr("Middle of the window, in seconds since the recording's start"),
      tr("Outcome of the window, and the reason of a miss"),
      tr("Detected points of the board"),
      tr("Distance of the board's points from their predictions by the last run, in pixels"),
      tr("Speed of the board in the image, in pixels per second: the median of its points")};
  if (role == Qt::DisplayRole) return titles[section];
  if (role == Qt::ToolTipRole || role == Qt::AccessibleTextRole) return helps[section];
  return {};
}

WindowListFilter::WindowListFilter(WindowListModel& model, QObject* parent)
    : QSortFilterProxyModel(parent), model_(model) {
  setSourceModel(&model);
  setSortRole(WindowListModel::kSortRole);
}

void WindowListFilter::setFilter(WindowFilter filter) {
  filter_ = filter;
  invalidateFilter();
}

bool WindowListFilter::filterAcceptsRow(int row, const QModelIndex&) const {
  switch (filter_) {
    case WindowFilter::All:
      return true;
    case WindowFilter::Missed:
      return model_.classOf(row) == WindowClass::Missed;
    case WindowFilter::Partial:
      return model_.classOf(row) == WindowClass::Partial;
    case WindowFilter::Rejected:
      return model_.classOf(row) == WindowClass::Rejected;
    case WindowFilter::Worst:
      return model_.window(row).rms_px >= model_.worstFrom_px();
  }
  return true;
}

}  // namespace evical::ui
