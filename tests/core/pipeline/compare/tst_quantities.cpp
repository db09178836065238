// Each row of core/data/quantity.h, through all code that iterates over them.
#include "core/base/error.h"
#include "core/data/quantity.h"
#include "core/data/quantity_difference.h"
#include "core/geometry/so3.h"
#include "core/pipeline/session/session_priors.h"
#include "core/report/truth_comparison.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fstream>
#include <set>

using namespace evical;

namespace {

// Values and sigmas that differ between rows, with all digits in use, so that a file must keep them all.
class Filler {
 public:
  double next() {
    ++count_;
    return 0.01 + count_ / 3000.0;
  }
  Eigen::Vector3d vector() {
    const double x = next(), y = next(), z = next();
    return {x, -y, z};
  }
  void fill(double& value) { value = next(); }
  void fill(Eigen::Vector3d& value) { value = vector(); }
  void fill(Eigen::Quaterniond& value) { value = quaternionExp(vector()).normalized(); }
  void fill(Eigen::Matrix3d& value) {
    value.setZero();
    for (int row = 0; row < 3; ++row)
      for (int col = row; col < 3; ++col) value(row, col) = (row == col ? 1.0 : 0.0) + next();
  }
  void fill(std::optional<CameraIntrinsics>& value) {
    value = CameraIntrinsics{CameraModel::PinholeRadtan,
                             {346, 260},
                             {300.0 + next(), 301.0},
                             {170.0, 130.0 + next()},
                             {next(), next(), next(), next(), next()}};
  }
  void fill(std::optional<std::array<double, 9>>& value) {
    for (double& each : value.emplace()) each = next();
  }
  void fill(KnownRotation& known) {
    fill(known.value);
    known.sigma = vector().cwiseAbs();
  }
  template <class Value>
  void fill(KnownValue<Value>& known) {
    fill(known.value);
    fill(known.sigma.emplace());
  }
  void fill(KnownVector& known) {
    fill(known.value);
    known.sigma = vector().cwiseAbs();
  }

 private:
  int count_ = 0;
};

void fillSigma(Filler& filler, Eigen::Vector3d& sigma) {
  sigma = filler.vector().cwiseAbs();
}
void fillSigma(Filler& filler, Eigen::Matrix3d& sigma) {
  sigma.setZero();
  for (int row = 0; row < 3; ++row)
    for (int col = row; col < 3; ++col) sigma(row, col) = filler.next();
}
template <class Sigma>
void fillSigma(Filler& filler, Sigma& sigma) {
  filler.fill(sigma);
}

Eigen::VectorXd priorNumbers(const KnownRotation& known) {
  return known.value.coeffs();
}
template <class Value>
Eigen::VectorXd priorNumbers(const KnownValue<Value>& known) {
  return quantityNumbers(known.value);
}

// A camera and an IMU in addition to the reference, with all properties of a row.
NamedResult filledResult() {
  NamedResult named;
  named.reference = "reference";
  named.cameras = {{"left"}};
  named.imus = {{"reference"}, {"far"}};
  Filler filler;
  CalibrationResult& result = test::ownResult(named);
  CalibrationState& state = result.state;
  UncertaintyReport& uncertainty = result.uncertainty;
  state.cameras.resize(1);
  uncertainty.cameras.resize(1);
  state.imus.resize(2);
  uncertainty.imus.resize(2);
  forEachQuantity(kCameraQuantities, [&](const auto& row) {
    filler.fill(row.value(state.cameras[0]));
    fillSigma(filler, row.sigma(uncertainty.cameras[0]));
  });
  forEachQuantity(kImuQuantities, [&](const auto& row) {
    filler.fill(row.value(state.imus[1]));
    fillSigma(filler, row.sigma(uncertainty.imus[1]));
  });
  return named;
}

}  // namespace

class TestQuantities : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  NamedResult readBack(const NamedResult& named) const {
    const std::filesystem::path path = std::filesystem::path(scratch_.path().toStdString()) / "result.yaml";
    std::ofstream(path) << resultYaml(named);
    return readResultYaml(path);
  }

  template <class Rows, class State, class Uncertainty>
  static void verifySame(const Rows& rows, const State& written, const State& read, const Uncertainty& sigma,
                         const Uncertainty& read_sigma) {
    forEachQuantity(rows, [&](const auto& row) {
      QVERIFY2(quantityNumbers(row.value(written)) == quantityNumbers(row.value(read)), row.info.name);
      const Eigen::VectorXd a = quantityNumbers(row.sigma(sigma)), b = quantityNumbers(row.sigma(read_sigma));
      QVERIFY2(a.size() == b.size() && a.norm() > 0.0 && (a - b).norm() < 1e-5 * a.norm(), row.info.name);
    });
  }

 private slots:
  void everyRow_readsBackFromAResult() {
    const NamedResult written = filledResult(), read = readBack(written);
    const Estimate a = estimateOf(written), b = estimateOf(read);
    verifySame(kCameraQuantities, a.cameras[0], b.cameras[0], a.uncertainty.cameras[0],
               b.uncertainty.cameras[0]);
    verifySame(kImuQuantities, a.imus[1], b.imus[1], a.uncertainty.imus[1], b.uncertainty.imus[1]);
  }

  void everyPrior_readsBackFromASession() {
    Session written;
    written.reference = "reference";
    written.cameras.resize(1);
    written.cameras[0].name = "left";
    written.imus.resize(2);
    written.imus[0].name = "reference";
    written.imus[1].name = "far";
    Session read = written;
    Filler filler;
    const auto fill = [&](auto& prior) {
      return [&](const auto& row) { filler.fill(row.prior(prior).emplace()); };
    };
    forEachPriorQuantity(kCameraQuantities, fill(written.cameras[0].prior));
    forEachPriorQuantity(kImuQuantities, fill(written.imus[1].prior));
    readSensorPriors(YamlNode::parse("prior:\n" + sensorPriorsYaml(written), "session.yaml")["prior"], read);
    const auto verify = [](const auto& a, const auto& b) {
      return [&](const auto& row) {
        QVERIFY2(row.prior(b).has_value(), row.info.name);
        QVERIFY2(priorNumbers(*row.prior(a)) == priorNumbers(*row.prior(b)), row.info.name);
        const Eigen::VectorXd sigma = quantityNumbers(*row.prior(a)->sigma);
        QVERIFY2((sigma - quantityNumbers(*row.prior(b)->sigma)).norm() < 1e-10 * sigma.norm(),
                 row.info.name);
      };
    };
    forEachPriorQuantity(kCameraQuantities, verify(written.cameras[0].prior, read.cameras[0].prior));
    forEachPriorQuantity(kImuQuantities, verify(written.imus[1].prior, read.imus[1].prior));
  }

  void everyRow_isCompared() {
    const Estimate a = estimateOf(filledResult());
    Estimate b = a;
    b.uncertainty = differenceUncertainty(a.uncertainty, a.uncertainty);
    std::set<std::string> compared;
    for (const QuantityDifference& each : difference(b, a)) {
      QVERIFY2(each.difference == 0.0, each.name.c_str());
      compared.insert(each.name);
    }
    const auto verify = [&](const std::string& sensor, const auto& row, const auto& value, const auto& sigma,
                            const auto& sigma_of_difference) {
      for (const QuantityPart& part : quantityParts(row.info, value))
        QVERIFY2(compared.contains(sensor + "." + part.name), part.name.c_str());
      const Eigen::VectorXd expected = std::sqrt(2.0) * quantityNumbers(sigma);
      QVERIFY2(expected.isApprox(quantityNumbers(sigma_of_difference), 1e-12), row.info.name);
    };
    forEachQuantity(kCameraQuantities, [&](const auto& row) {
      verify("left", row, row.value(a.cameras[0]), row.sigma(a.uncertainty.cameras[0]),
             row.sigma(b.uncertainty.cameras[0]));
    });
    forEachQuantity(kImuQuantities, [&](const auto& row) {
      verify("far", row, row.value(a.imus[1]), row.sigma(a.uncertainty.imus[1]),
             row.sigma(b.uncertainty.imus[1]));
    });
  }

  // One camera or IMU each has the same place in any rig; of several, only the name identifies one.
  void onlySensors_areComparedWithAnyNames() {
    NamedResult result = filledResult(), truth = result;
    truth.cameras.at(0).name = "davis";
    const TruthComparison compared = compareWithTruth(result, truth);
    QCOMPARE(compared.notes.size(), std::size_t{1});
    QVERIFY2(comparisonTable(compared).find("'left' is compared with 'davis'") != std::string::npos,
             comparisonTable(compared).c_str());
    QCOMPARE(compareWithTruth(result, result).quantities.size(), compared.quantities.size());
    QVERIFY(compareWithTruth(result, result).notes.empty());
    truth.imus.at(1).name = "other";
    QVERIFY_THROWS_EXCEPTION(CalibrationError, compareWithTruth(result, truth));

    // The only IMU is the reference as well.
    NamedResult one = result;
    one.imus.resize(1);
    test::ownResult(one).state.imus.resize(1);
    NamedResult renamed = one;
    renamed.reference = renamed.imus.at(0).name = "davis_imu";
    QCOMPARE(compareWithTruth(one, renamed).notes.size(), std::size_t{1});
  }

  // Only estimates have edge localisation biases: those of two estimates are compared, but not with a truth.
  void edgeLocalisationBias_areComparedBetweenResults() {
    const NamedResult result = filledResult();
    NamedResult other = result;
    CameraState& camera = test::ownResult(other).state.cameras[0];
    camera.edge_localisation_bias_px += 0.25;
    camera.slow_edge_localisation_bias_px -= 0.125;
    const auto found = [](const TruthComparison& comparison, const std::string& name) {
      for (const QuantityDifference& each : comparison.quantities)
        if (each.name == name) return each;
      return QuantityDifference{};
    };
    const TruthComparison comparison = compareWithTruth(other, result);
    const QuantityDifference lead = found(comparison, "left.edge_localisation_bias");
    const QuantityDifference slow = found(comparison, "left.slow_edge_localisation_bias");
    QVERIFY(std::abs(lead.difference - 0.25) < 1e-12 && std::abs(slow.difference + 0.125) < 1e-12);
    QCOMPARE(lead.sigma, result.result->uncertainty.cameras[0].edge_localisation_bias_std_px);
    QCOMPARE(slow.sigma, result.result->uncertainty.cameras[0].slow_edge_localisation_bias_std_px);
    QCOMPARE(QString::fromStdString(lead.unit), QString("px"));
    NamedResult truth = result;
    test::ownResult(truth).uncertainty = {};
    QVERIFY(found(compareWithTruth(other, truth), "left.edge_localisation_bias").name.empty());
    QVERIFY(!found(compareWithTruth(other, truth), "left.time_offset").name.empty());
  }

  void names_areUniqueInARig() {
    std::set<std::string> names;
    const auto add = [&](const std::string& sensor, const auto& row, const auto& value) {
      for (const QuantityPart& part : quantityParts(row.info, value))
        QVERIFY2(names.insert(sensor + "." + part.name).second, part.name.c_str());
    };
    const CalibrationState state = filledResult().result->state;
    forEachQuantity(kCameraQuantities,
                    [&](const auto& row) { add("left", row, row.value(state.cameras[0])); });
    forEachQuantity(kImuQuantities, [&](const auto& row) { add("far", row, row.value(state.imus[1])); });
  }
};

EVICAL_TEST(TestQuantities)
#include "tst_quantities.moc"
