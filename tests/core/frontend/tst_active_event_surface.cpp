#include "core/frontend/normal_flow.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

class TestActiveEventSurface : public QObject {
  Q_OBJECT
 private slots:
  void pixel_keepsItsLastEdge();
  void polarities_areSurfacesOfTheirOwn();
  void neighbours_areReadAcrossTheBorder();
  void pixels_areListedOnce();
};

void TestActiveEventSurface::pixel_keepsItsLastEdge() {
  const SyntheticWindow later_last({burstAt(20, 30, -0.004, false), burstAt(20, 30, 0.003, false)});
  QCOMPARE(*ActiveEventSurface(later_last.window, 1).at(true, 20, 30), 0.003f);
  const SyntheticWindow later_first({burstAt(20, 30, 0.003, false), burstAt(20, 30, -0.004, false)});
  QCOMPARE(*ActiveEventSurface(later_first.window, 1).at(true, 20, 30), 0.003f);
}

// Darker edges lead at dark circles, brighter ones at bright circles.
void TestActiveEventSurface::polarities_areSurfacesOfTheirOwn() {
  const std::vector<EdgeCrossing> bursts = {burstAt(20, 30, 0.001, false), burstAt(20, 30, 0.002, true)};
  const SyntheticWindow dark(bursts, CircleShade::Dark), bright(bursts, CircleShade::Bright);
  const ActiveEventSurface of_dark(dark.window, 1), of_bright(bright.window, 1);
  QCOMPARE(*of_dark.at(true, 20, 30), 0.001f);
  QCOMPARE(*of_dark.at(false, 20, 30), 0.002f);
  QCOMPARE(*of_bright.at(true, 20, 30), 0.002f);
  QCOMPARE(*of_bright.at(false, 20, 30), 0.001f);
}

void TestActiveEventSurface::neighbours_areReadAcrossTheBorder() {
  const int right = kDavis_px.width_px - 1, bottom = kDavis_px.height_px - 1;
  const SyntheticWindow corners({burstAt(0, 0, 0.001, false), burstAt(right, bottom, 0.002, false)});
  constexpr int kBorder_px = 2;
  const ActiveEventSurface surface(corners.window, kBorder_px);
  int active = 0;
  for (int dy = -kBorder_px; dy <= kBorder_px; ++dy) {
    for (int dx = -kBorder_px; dx <= kBorder_px; ++dx) {
      const int step = dy * surface.stride() + dx;
      active += ActiveEventSurface::active(surface.at(true, 0, 0)[step]);
      active += ActiveEventSurface::active(surface.at(true, right, bottom)[step]);
    }
  }
  QCOMPARE(active, 2);
  // One to the right and one down from a neighbour is the pixel itself.
  QCOMPARE(surface.at(true, right - 1, bottom - 1)[surface.stride() + 1], 0.002f);
}

void TestActiveEventSurface::pixels_areListedOnce() {
  const SyntheticWindow synthetic({burstAt(5, 6, 0.001, false), burstAt(5, 6, 0.002, false),
                                   burstAt(5, 6, 0.003, true), burstAt(7, 6, 0.0, true)});
  const ActiveEventSurface surface(synthetic.window, 1);
  QCOMPARE(surface.pixels().size(), std::size_t{3});
  int leading = 0;
  for (const ActivePixel& pixel : surface.pixels()) {
    QVERIFY(pixel.y_px == 6 && (pixel.x_px == 5 || pixel.x_px == 7));
    leading += pixel.leading;
  }
  QCOMPARE(leading, 1);
}

}  // namespace

EVICAL_TEST(TestActiveEventSurface)
#include "tst_active_event_surface.moc"
