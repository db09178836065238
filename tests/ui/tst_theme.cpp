// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/test_program.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QDirIterator>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>

#include <algorithm>
#include <array>
#include <cmath>

using namespace evical::ui;

namespace {

// Contrast of WCAG 2: text should have at least 4.5.
double luminance(const QColor& colour) {
  const auto linear = [](double c) { return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) + 0.0722 * linear(colour.blueF());
}

double contrast(const QColor& a, const QColor& b) {
  const double brighter = std::max(luminance(a), luminance(b)), darker = std::min(luminance(a), luminance(b));
  return (brighter + 0.05) / (darker + 0.05);
}

double toLinear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Colours as seen with a lack of one kind of cones: G. Machado, M. Oliveira, L. Fernandes, A
// Physiologically-based Model for Simulation of Color Vision Deficiency, 2009, severity 1, of linear RGB.
using Vision = std::array<std::array<double, 3>, 3>;
constexpr Vision kDeuteranopia = {
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}};
constexpr Vision kProtanopia = {
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}};

std::array<double, 3> times(const Vision& matrix, const std::array<double, 3>& v) {
  std::array<double, 3> product{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) product[i] += matrix[i][k] * v[k];
  return product;
}

// CIE L*a*b*, D65, of the perceived colour.
std::array<double, 3> labOf(const QColor& colour, const Vision& vision) {
  std::array<double, 3> seen =
      times(vision, {toLinear(colour.redF()), toLinear(colour.greenF()), toLinear(colour.blueF())});
  for (double& c : seen) c = std::clamp(c, 0.0, 1.0);
  constexpr Vision kXyz = {{{0.4124564 / 0.95047, 0.3575761 / 0.95047, 0.1804375 / 0.95047},
                            {0.2126729, 0.7151522, 0.0721750},
                            {0.0193339 / 1.08883, 0.1191920 / 1.08883, 0.9503041 / 1.08883}}};
  std::array<double, 3> f = times(kXyz, seen);
  for (double& x : f) x = x > 0.008856 ? std::cbrt(x) : 7.787 * x + 16.0 / 116.0;
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

double difference(const QColor& a, const QColor& b, const Vision& vision) {
  const std::array<double, 3> x = labOf(a, vision), y = labOf(b, vision);
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

// Mean colour of the drawn pixels, and their share of the picture.
struct Ink {
  QColor colour;
  double share = 0.0;
};

Ink inkOf(const QPixmap& pixmap) {
  const QImage image = pixmap.toImage().convertToFormat(QImage::Format_ARGB32);
  double red = 0, green = 0, blue = 0, weight = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const QColor pixel = image.pixelColor(x, y);
      weight += pixel.alphaF();
      red += pixel.alphaF() * pixel.redF();
      green += pixel.alphaF() * pixel.greenF();
      blue += pixel.alphaF() * pixel.blueF();
    }
  }
  if (weight == 0) return {};
  return {QColor::fromRgbF(static_cast<float>(red / weight), static_cast<float>(green / weight),
                           static_cast<float>(blue / weight)),
          weight / (image.width() * image.height())};
}

}  // namespace

class TestTheme : public QObject {
  Q_OBJECT

 private slots:
  // 2.3 is just noticeable between adjacent colours; separate thin lines need far more.
  void states_andAxes_areToldApart_byWhoSeesNoRedOrNoGreen() {
    constexpr double kWellApart = 20.0, kMinContrast = 3.0;
    for (const Appearance appearance : {Appearance::Light, Appearance::Dark}) {
      applyTheme(*qApp, appearance);
      const Theme& t = theme();
      for (const std::array<QColor, 3>& three : {std::array{t.good, t.warning, t.bad}, t.axes}) {
        for (std::size_t i = 0; i < 3; ++i) {
          QVERIFY2(contrast(three[i], t.panel) > kMinContrast, qPrintable(three[i].name()));
          for (const Vision& vision : {kDeuteranopia, kProtanopia})
            QVERIFY2(difference(three[i], three[(i + 1) % 3], vision) > kWellApart,
                     qPrintable(three[i].name() + three[(i + 1) % 3].name()));
        }
      }
    }
  }

  void appearance_setsPaletteAndColours() {
    applyTheme(*qApp, Appearance::Dark);
    QVERIFY(theme().dark);
    QCOMPARE(QApplication::palette().color(QPalette::Window), theme().window);
    applyTheme(*qApp, Appearance::Light);
    QVERIFY(!theme().dark);
    QCOMPARE(QApplication::palette().color(QPalette::Base), theme().panel);
  }

  void text_isReadable_data() {
    QTest::addColumn<bool>("dark");
    QTest::newRow("light") << false;
    QTest::newRow("dark") << true;
  }
  void text_isReadable() {
    QFETCH(bool, dark);
    applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
    const Theme& t = theme();
    const QPalette palette = QApplication::palette();
    for (const QColor& ground : {t.window, t.panel}) {
      QVERIFY(contrast(t.text, ground) > 7.0);
      QVERIFY(contrast(t.faint_text, ground) > 4.5);
      QVERIFY(contrast(t.bad, ground) > 4.5);
    }
    QVERIFY(contrast(palette.color(QPalette::HighlightedText), palette.color(QPalette::Highlight)) > 4.5);
  }

  void fields_haveVisibleOutlines_data() { text_isReadable_data(); }
  void fields_haveVisibleOutlines() {
    QFETCH(bool, dark);
    applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
    QWidget window;
    QCheckBox box(&window);
    QLineEdit line(&window);
    QSpinBox number(&window);
    box.setGeometry(10, 10, 40, 30);
    line.setGeometry(10, 50, 100, 26);
    number.setGeometry(10, 90, 100, 26);
    window.resize(120, 130);
    window.show();
    const QImage picture = window.grab().toImage();
    // Along the left edge there is a line that contrasts with the window.
    for (const QWidget* const field : std::initializer_list<QWidget*>{&box, &line, &number}) {
      double best = 1.0;
      for (int x = field->x(); x < field->x() + 8; ++x)
        best =
            std::max(best, contrast(picture.pixelColor(x, field->geometry().center().y()), theme().window));
      QVERIFY2(best > 1.6, qPrintable(QString::number(best)));
    }
  }

  void everyIcon_drawsSomethingInTheTextColour() {
    applyTheme(*qApp, Appearance::Dark);
    QVERIFY(!icon("open").isNull());
    int count = 0;
    for (QDirIterator files(":/icons"); files.hasNext(); ++count) {
      const QString name = QFileInfo(files.next()).baseName();
      const Ink ink = inkOf(icon(name).pixmap(48, 48));
      QVERIFY2(ink.share > 0.01 && ink.share < 0.6, qPrintable(name));
      QVERIFY2(contrast(ink.colour, theme().text) < 1.05, qPrintable(name));
    }
    QVERIFY(count > 40);
  }

  void icon_thatDoesNotExist_isNull() { QVERIFY(icon("no such icon").isNull()); }

  void icon_followsTheTheme() {
    applyTheme(*qApp, Appearance::Light);
    const QIcon open = icon("open");
    const QColor light = inkOf(open.pixmap(24, 24)).colour;
    applyTheme(*qApp, Appearance::Dark);
    const QColor dark = inkOf(open.pixmap(24, 24)).colour;
    QVERIFY(light.lightness() < 80);
    QVERIFY(dark.lightness() > 170);
  }

  void icon_inItsOwnColour_fadesWhenDisabled() {
    const QIcon done = icon("done", QColor(0, 200, 0));
    QVERIFY(inkOf(done.pixmap(48, 48)).colour.green() > 190);
    QVERIFY(inkOf(done.pixmap(48, 48, QIcon::Disabled)).share < 0.7 * inkOf(done.pixmap(48, 48)).share);
  }

  void widgets_areToldOfAChange() {
    applyTheme(*qApp, Appearance::Light);
    QPushButton button("Calibrate");
    button.show();
    const QColor light = button.grab().toImage().pixelColor(button.width() / 2, 3);
    applyTheme(*qApp, Appearance::Dark);
    const QColor dark = button.grab().toImage().pixelColor(button.width() / 2, 3);
    QVERIFY(light.lightness() > 200);
    QVERIFY(dark.lightness() < 80);
  }
};

EVICAL_TEST(TestTheme)
#include "tst_theme.moc"
