#include "core/frontend/normal_flow.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

// Normal flow on the front or back half of a circle that moves along +x, three pixels thick.
NormalFlowField arc(const Eigen::Vector2d& centre_px, double radius_px, bool leading,
                    double speed_px_s = 100.0) {
  NormalFlowField field;
  for (int y = 0; y < kDavis_px.height_px; ++y) {
    for (int x = 0; x < kDavis_px.width_px; ++x) {
      const Eigen::Vector2d d = Eigen::Vector2d(x, y) - centre_px;
      const double distance = d.norm();
      if (std::abs(distance - radius_px) > 1.5) continue;
      const double cosine = d.x() / distance;
      if (leading ? cosine < 0.3 : cosine > -0.3) continue;
      const Eigen::Vector2d normal_velocity = speed_px_s * cosine * d / distance;
      field.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), leading, 0.0f,
                       normal_velocity.cast<float>()});
    }
  }
  return field;
}

void append(NormalFlowField& field, const NormalFlowField& more) {
  field.insert(field.end(), more.begin(), more.end());
}

class TestEventClusters : public QObject {
  Q_OBJECT
 private slots:
  void arcs_areClassified_data();
  void arcs_areClassified();
  void straightEdge_isOther();
  void gaps_joinUpToTheDilation();
  void polarities_areApart();
  void smallClusters_areDropped();
  void border_isNoObstacle();
};

void TestEventClusters::arcs_areClassified_data() {
  QTest::addColumn<double>("radius_px");
  for (const double radius_px : {4.0, 8.0, 20.0, 50.0})
    QTest::addRow("radius %.0f px", radius_px) << radius_px;
}

void TestEventClusters::arcs_areClassified() {
  QFETCH(double, radius_px);
  NormalFlowField field = arc({150.0, 120.0}, radius_px, true);
  append(field, arc({150.0, 120.0}, radius_px, false));
  const std::vector<EventCluster> clusters = clusterFlow(field, kDavis_px, NormalFlowOptions{});
  QCOMPARE(clusters.size(), 2u);
  for (const EventCluster& cluster : clusters) {
    QCOMPARE(cluster.kind, cluster.leading ? ClusterKind::Run : ClusterKind::Chase);
    QVERIFY(cluster.direction.x() > 0.99);
    QVERIFY(std::abs(cluster.centroid_px.y() - 120.0) < 0.5);
    QVERIFY(cluster.leading == (cluster.centroid_px.x() > 150.0));
  }
}

void TestEventClusters::straightEdge_isOther() {
  std::mt19937 random(60);
  std::normal_distribution<double> normal;
  NormalFlowField field;
  for (int y = 50; y < 90; ++y) {
    for (int x = 100; x < 103; ++x) {
      const Eigen::Vector2d noise = test::randomVector<2>([&] { return normal(random); });
      field.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), true, 0.0f,
                       (Eigen::Vector2d(100.0, 0.0) + 10.0 * noise).cast<float>()});
    }
  }
  const std::vector<EventCluster> clusters = clusterFlow(field, kDavis_px, NormalFlowOptions{});
  QCOMPARE(clusters.size(), 1u);
  QCOMPARE(clusters[0].kind, ClusterKind::Other);
  QCOMPARE(clusters[0].flows.size(), field.size());
}

NormalFlowField block(int x_begin, int width, bool leading) {
  NormalFlowField field;
  for (int y = 50; y < 56; ++y) {
    for (int x = x_begin; x < x_begin + width; ++x)
      field.push_back(
          {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), leading, 0.0f, {50.0f, 0.0f}});
  }
  return field;
}

void TestEventClusters::gaps_joinUpToTheDilation() {
  const auto clustersAcross = [](int empty_columns, int dilation_px) {
    NormalFlowField field = block(100, 5, true);
    append(field, block(105 + empty_columns, 5, true));
    NormalFlowOptions options;
    options.dilation_px = dilation_px;
    return clusterFlow(field, kDavis_px, options).size();
  };
  // Both sides grow by the dilation; then they must touch.
  QCOMPARE(clustersAcross(2, 1), 1u);
  QCOMPARE(clustersAcross(3, 1), 2u);
  QCOMPARE(clustersAcross(0, 0), 1u);
  QCOMPARE(clustersAcross(1, 0), 2u);
}

void TestEventClusters::polarities_areApart() {
  NormalFlowField field = block(100, 5, true);
  append(field, block(105, 5, false));
  QCOMPARE(clusterFlow(field, kDavis_px, NormalFlowOptions{}).size(), 2u);
}

void TestEventClusters::smallClusters_areDropped() {
  NormalFlowOptions options;
  options.min_cluster_px = 13;
  QVERIFY(clusterFlow(block(100, 2, true), kDavis_px, options).empty());
  options.min_cluster_px = 12;
  QCOMPARE(clusterFlow(block(100, 2, true), kDavis_px, options).size(), 1u);
}

void TestEventClusters::border_isNoObstacle() {
  NormalFlowField field = arc({0.0, 0.0}, 20.0, true);
  append(field, arc({345.0, 259.0}, 20.0, false));
  QCOMPARE(clusterFlow(field, kDavis_px, NormalFlowOptions{}).size(), 2u);
}

}  // namespace

EVICAL_TEST(TestEventClusters)
#include "tst_event_clusters.moc"
