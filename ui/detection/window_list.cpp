// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_list.h"

#include "ui/detection/window_list_model.h"
#include "ui/theme/theme.h"

#include <QApplication>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QMenu>
#include <QPainter>
#include <QPixmap>
#include <QPushButton>
#include <QScrollBar>
#include <QShortcut>
#include <QStackedLayout>
#include <QTreeView>
#include <QVBoxLayout>

#include <algorithm>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kWholeTable_px = 400;  // below, hides numbers that tooltips contain

// Excluded times, with those of the rows added or removed.
std::vector<double> changed(std::vector<double> times_s, const WindowListModel& model,
                            const std::vector<int>& rows, bool reject) {
  for (const int row : rows) {
    if (!model.window(row).has_view) continue;
    const double time_s = model.window(row).report.time_s;
    const auto place = std::lower_bound(times_s.begin(), times_s.end(), time_s);
    const bool there = place != times_s.end() && *place == time_s;
    if (reject && !there) times_s.insert(place, time_s);
    if (!reject && there) times_s.erase(place);
  }
  return times_s;
}

}  // namespace

WindowList::WindowList(QWidget* parent)
    : QWidget(parent),
      pictures_(new WindowPictures(this)),
      model_(new WindowListModel(*pictures_, this)),
      filter_(new WindowListFilter(*model_, this)) {
  makeTable();
  note_ = new QLabel;
  note_->setWordWrap(true);
  note_->setAlignment(Qt::AlignCenter);
  note_->setMargin(16);
  auto* const middle = new QWidget;
  stack_ = new QStackedLayout(middle);
  stack_->addWidget(note_);
  stack_->addWidget(table_);
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  column->addWidget(makeFilterBar());
  column->addWidget(middle, 1);
  column->addWidget(makeActions());
  soon_.setSingleShot(true);
  connect(&soon_, &QTimer::timeout, this, &WindowList::askForPictures);
  connect(pictures_, &WindowPictures::made, model_, &WindowListModel::pictureWasMade);
  refresh();
}

QWidget* WindowList::makeFilterBar() {
  auto* const bar = new QWidget;
  auto* const row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 0, 0);
  filter_box_ = new QComboBox;
  filter_box_->addItems({tr("All windows"), tr("Missed"), tr("Partial"), tr("Rejected"), tr("Worst RMS")});
  filter_box_->setAccessibleName(tr("Filter of the windows"));
  filter_box_->setToolTip(tr("Filter of the windows. Worst: the tenth with the largest RMS"));
  count_ = new QLabel;
  row->addWidget(filter_box_);
  row->addWidget(count_, 1);
  connect(filter_box_, &QComboBox::currentIndexChanged, this, [this](int chosen) {
    filter_->setFilter(static_cast<WindowFilter>(chosen));
    if (filter_->filter() == WindowFilter::Worst)
      table_->sortByColumn(WindowListModel::Rms, Qt::DescendingOrder);
    followTime();
    refresh();
    wantPictures();
  });
  return bar;
}

void WindowList::makeTable() {
  table_ = new QTreeView;
  table_->setModel(filter_);
  table_->setObjectName("windows");
  table_->setAccessibleName(tr("Windows"));
  table_->setRootIsDecorated(false);
  table_->setItemsExpandable(false);
  table_->setUniformRowHeights(true);
  table_->setAllColumnsShowFocus(true);
  table_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  table_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  table_->setContextMenuPolicy(Qt::CustomContextMenu);
  table_->setItemDelegate(new WindowRowPainter(table_));
  table_->setSortingEnabled(true);
  table_->sortByColumn(WindowListModel::Time, Qt::AscendingOrder);
  QHeaderView& header = *table_->header();
  header.setSectionsMovable(false);
  header.setStretchLastSection(false);
  header.setMinimumSectionSize(20);
  header.setSectionResizeMode(QHeaderView::Fixed);
  header.setSectionResizeMode(WindowListModel::State, QHeaderView::Stretch);
  header.setSortIndicatorClearable(false);
  connect(table_->selectionModel(), &QItemSelectionModel::currentChanged, this,
          [this](const QModelIndex& now) {
            if (following_ || !now.isValid()) return;
            time_s_ = model_->window(filter_->mapToSource(now).row()).report.time_s;
            emit windowChosen(time_s_);
          });
  connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &WindowList::refresh);
  connect(table_, &QTreeView::customContextMenuRequested, this, &WindowList::showMenu);
  connect(table_->verticalScrollBar(), &QScrollBar::valueChanged, this, &WindowList::wantPictures);
  connect(filter_, &QAbstractItemModel::layoutChanged, this, &WindowList::wantPictures);
  const auto add_key = [this](const QKeySequence& key, auto act) {
    auto* const shortcut = new QShortcut(key, table_);
    shortcut->setContext(Qt::WidgetShortcut);
    connect(shortcut, &QShortcut::activated, this, act);
  };
  add_key(Qt::Key_Delete, [this] { rejectSelected(); });
  add_key(Qt::SHIFT | Qt::Key_Delete, [this] { keepSelected(); });
}

QPushButton* WindowList::addAction(QHBoxLayout* row, const QString& icon_name, const QString& text,
                                   const QString& help) {
  auto* const button = new QPushButton(icon(icon_name), text);
  button->setToolTip(help);
  row->addWidget(button);
  return button;
}

QWidget* WindowList::makeActions() {
  auto* const bar = new QWidget;
  auto* const column = new QVBoxLayout(bar);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  auto* const row = new QHBoxLayout;
  row->setSpacing(4);
  reject_ = addAction(row, "remove", tr("Reject"),
                      tr("Exclude the selected windows from all later calibrations (Delete)"));
  keep_ = addAction(row, "check", tr("Keep"), tr("Include the selected windows again (Shift+Delete)"));
  pending_ = new QLabel;
  pending_->setWordWrap(true);
  pending_->setMinimumHeight(pending_->fontMetrics().height());  // rows must not move at the first rejection
  column->addWidget(pending_);
  column->addLayout(row);
  connect(reject_, &QPushButton::clicked, this, &WindowList::rejectSelected);
  connect(keep_, &QPushButton::clicked, this, &WindowList::keepSelected);
  return bar;
}

void WindowList::setRun(std::shared_ptr<const CalibrationRun> run, std::size_t camera, const QString& note) {
  note_->setText(run ? tr("Listing the windows ...") : note);
  stack_->setCurrentWidget(note_);
  pictures_->forget();
  model_->setWindows({}, CameraKind::Events);
  refresh();
  if (!run) return job_.discard();
  job_.start([this, run, camera](const std::stop_token&) {
    const CameraKind kind = run->detections.cameras.at(camera).kind;
    return [this, rows = windowRows(*run, camera), kind] {
      model_->setWindows(rows, kind);
      stack_->setCurrentWidget(table_);
      followTime();
      refresh();
      wantPictures();
      emit filled();
    };
  });
}

void WindowList::setRejectable(bool rejectable) {
  rejectable_ = rejectable;
  refresh();
}

void WindowList::setRejected(std::vector<double> times_s) {
  rejected_s_ = times_s;
  model_->setRejected(std::move(times_s));
  refresh();
}

void WindowList::setPending(int to_reject, int to_keep) {
  to_reject_ = to_reject;
  to_keep_ = to_keep;
  refresh();
}

void WindowList::setBusy(bool busy) {
  busy_ = busy;
  refresh();
}

void WindowList::setSource(const PictureSource& source, const SurfaceStyle& style) {
  const double ratio = devicePixelRatioF();
  pictures_->setSource(source, style, (QSizeF(kPictureSize_px) * ratio).toSize(), ratio);
  wantPictures();
}

void WindowList::setTime(double time_s) {
  if (time_s == time_s_) return;
  time_s_ = time_s;
  followTime();
}

void WindowList::setFilter(WindowFilter filter) {
  filter_box_->setCurrentIndex(static_cast<int>(filter));
}

// A selection of several rows stays when the cursor moves.
void WindowList::followTime() {
  const auto row = model_->rowAt(time_s_);
  const QModelIndex now = row ? filter_->mapFromSource(model_->index(*row, 0)) : QModelIndex();
  QItemSelectionModel& selection = *table_->selectionModel();
  if (!now.isValid() || now == selection.currentIndex().siblingAtColumn(0)) return;
  following_ = true;
  const bool several = selection.selectedRows().size() > 1;
  selection.setCurrentIndex(now, several ? QItemSelectionModel::NoUpdate
                                         : QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
  following_ = false;
  table_->scrollTo(now);
}

std::vector<int> WindowList::selectedWindows() const {
  std::vector<int> rows;
  for (const QModelIndex& index : table_->selectionModel()->selectedRows())
    rows.push_back(filter_->mapToSource(index).row());
  std::sort(rows.begin(), rows.end());
  return rows;
}

bool WindowList::canChange(bool reject) const {
  const std::vector<int> rows = selectedWindows();
  return rejectable_ && !busy_ && changed(rejected_s_, *model_, rows, reject) != rejected_s_;
}

void WindowList::changeSelected(bool reject) {
  if (!canChange(reject)) return;
  const std::vector<double> times_s = changed(rejected_s_, *model_, selectedWindows(), reject);
  const auto count = static_cast<int>(times_s.size()) - static_cast<int>(rejected_s_.size());
  const QString what = reject ? (count == 1 ? tr("Reject a window") : tr("Reject %1 windows").arg(count))
                              : (count == -1 ? tr("Keep a window") : tr("Keep %1 windows").arg(-count));
  emit rejectionWanted(times_s, what);
}

void WindowList::showMenu(const QPoint& at) {
  QMenu menu(this);
  QAction* const reject = menu.addAction(reject_->icon(), tr("Reject"), this, &WindowList::rejectSelected);
  QAction* const keep = menu.addAction(keep_->icon(), tr("Keep"), this, &WindowList::keepSelected);
  reject->setShortcut(Qt::Key_Delete);
  keep->setShortcut(Qt::SHIFT | Qt::Key_Delete);
  reject->setEnabled(reject_->isEnabled());
  keep->setEnabled(keep_->isEnabled());
  menu.exec(table_->viewport()->mapToGlobal(at));
}

void WindowList::wantPictures() {
  constexpr int kSoon_ms = 30;  // while scrolling, only the final position counts
  if (!soon_.isActive()) soon_.start(kSoon_ms);
}

void WindowList::askForPictures() {
  if (!isVisible() || filter_->rowCount() == 0) return;
  std::vector<PictureWish> wishes;
  QModelIndex index = table_->indexAt({1, 1});
  for (; index.isValid(); index = table_->indexBelow(index)) {
    if (table_->visualRect(index).top() > table_->viewport()->height()) break;
    const int row = filter_->mapToSource(index).row();
    const WindowReport& report = model_->window(row).report;
    wishes.push_back({row, report.time_s, report.half_width_s});
  }
  pictures_->want(std::move(wishes));
}

void WindowList::fitColumns() {
  const QFontMetrics metrics = table_->fontMetrics();
  constexpr int kMargin_px = 12, kSortMark_px = 8;
  const auto width = [&](const QString& widest) { return metrics.horizontalAdvance(widest) + kMargin_px; };
  QHeaderView& header = *table_->header();
  header.resizeSection(WindowListModel::Picture, kPictureSize_px.width() + 8);
  header.resizeSection(WindowListModel::Time, width(QStringLiteral("000.000")));
  header.resizeSection(WindowListModel::Circles, width(tr("Points")) + kSortMark_px);
  header.resizeSection(WindowListModel::Rms, width(tr("RMS px")) + kSortMark_px);
  header.resizeSection(WindowListModel::Speed, width(QStringLiteral("0000")) + kSortMark_px);
  const bool narrow = this->width() < kWholeTable_px;
  header.setSectionHidden(WindowListModel::Circles, narrow);
  header.setSectionHidden(WindowListModel::Speed, narrow);
}

void WindowList::refresh() {
  const int all = model_->rowCount(), shown = filter_->rowCount();
  count_->setText(all == 0 ? QString() : tr("%L1 of %L2").arg(shown).arg(all));
  filter_box_->setEnabled(all > 0);
  reject_->setEnabled(canChange(true));
  keep_->setEnabled(canChange(false));
  QStringList parts;
  if (to_reject_ > 0) parts << tr("%1 to be rejected").arg(to_reject_);
  if (to_keep_ > 0) parts << tr("%1 to be included again").arg(to_keep_);
  pending_->setText(parts.isEmpty() ? QString() : tr("Calibrate (F5): %1").arg(parts.join(tr(", "))));
}

void WindowList::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  fitColumns();
  wantPictures();
}

void WindowList::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  fitColumns();
  wantPictures();
}

namespace {

constexpr int kMark_px = 8, kGap_px = 8;
constexpr double kFoundHeight = 0.7;  // relative to a missed one's mark, as on the timeline

}  // namespace

void WindowRowPainter::paint(QPainter* painter, const QStyleOptionViewItem& option,
                             const QModelIndex& index) const {
  if (index.column() != WindowListModel::Picture && index.column() != WindowListModel::State)
    return QStyledItemDelegate::paint(painter, option, index);
  QStyleOptionViewItem empty = option;
  initStyleOption(&empty, index);
  empty.text.clear();
  empty.icon = {};
  empty.features &= ~QStyleOptionViewItem::HasDecoration;
  const QStyle& style = option.widget != nullptr ? *option.widget->style() : *QApplication::style();
  style.drawControl(QStyle::CE_ItemViewItem, &empty, painter, option.widget);
  painter->save();
  if (index.column() == WindowListModel::Picture)
    paintPicture(*painter, option.rect, index);
  else
    paintState(*painter, empty, index);
  painter->restore();
}

QSize WindowRowPainter::sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const {
  const int two_lines = 2 * option.fontMetrics.height();
  return {QStyledItemDelegate::sizeHint(option, index).width(),
          std::max(kPictureSize_px.height(), two_lines) + 6};
}

void WindowRowPainter::paintPicture(QPainter& painter, const QRect& cell, const QModelIndex& index) {
  QRect place(QPoint(), kPictureSize_px);
  place.moveCenter(cell.center());
  const auto picture = index.data(Qt::DecorationRole).value<QPixmap>();
  if (!picture.isNull()) {
    place.setSize(picture.deviceIndependentSize().toSize());
    place.moveCenter(cell.center());
    painter.drawPixmap(place, picture);
  } else {
    painter.fillRect(place, theme().window);
  }
  painter.setPen(theme().grid_line);
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(place);
}

void WindowRowPainter::paintState(QPainter& painter, const QStyleOptionViewItem& option,
                                  const QModelIndex& index) {
  const auto key = index.data(WindowListModel::kSortRole).toInt();
  const auto window_class = static_cast<WindowClass>(key / 100);
  const QRect cell = option.rect.adjusted(4, 6, -4, -6);
  const double height = cell.height() * (window_class == WindowClass::Missed ? 1.0 : kFoundHeight);
  const QRectF mark(cell.left(), cell.bottom() + 1 - height, kMark_px, height);
  const QColor background = option.state & QStyle::State_Selected ? option.palette.highlight().color()
                                                                  : option.palette.base().color();
  painter.fillRect(mark, background);
  painter.fillRect(mark, windowBrush(window_class));
  const QRect text = cell.adjusted(kMark_px + kGap_px, -4, 0, 4);
  const QString second = index.data(WindowListModel::kSecondLineRole).toString();
  const bool selected = option.state & QStyle::State_Selected;
  const QColor first_colour = option.palette.color(selected ? QPalette::HighlightedText : QPalette::Text);
  const QFontMetrics& metrics = option.fontMetrics;
  const auto line = [&](const QRect& at, const QColor& colour, const QString& words) {
    painter.setPen(colour);
    painter.drawText(at, Qt::AlignLeft | Qt::AlignVCenter,
                     metrics.elidedText(words, Qt::ElideRight, at.width()));
  };
  if (second.isEmpty()) return line(text, first_colour, index.data().toString());
  const int half = text.height() / 2;
  line(text.adjusted(0, 0, 0, -half), first_colour, index.data().toString());
  line(text.adjusted(0, half, 0, 0), selected ? first_colour : theme().faint_text, second);
}

}  // namespace evical::ui
