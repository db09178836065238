// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/lens/lens_parameters.h"

#include "core/base/number.h"
#include "core/geometry/camera_intrinsics.h"

#include <QObject>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::ui {
namespace {

constexpr std::size_t kPixelNumbers = 4;  // fx fy cx cy; distortion has no unit

// Number of decimals up to the sigma's second digit.
QString lensText(double value, double sigma) {
  constexpr int kMax = 8;
  return QString::number(value, 'f', decimalsFor(sigma, kMax));
}

QString pixels(double value) {
  return QString::number(value, 'g', 3);
}

QString sigmaText(double sigma) {
  return sigma > 0.0 ? lensText(sigma, sigma) : QObject::tr("fixed");
}

QString lensNameOf(std::size_t number, CameraModel model) {
  const std::array names = {QObject::tr("Focal length x"), QObject::tr("Focal length y"),
                            QObject::tr("Principal point x"), QObject::tr("Principal point y")};
  if (number < kPixelNumbers) return names[number];
  return QObject::tr("Distortion %1").arg(distortionNames(model)[number - kPixelNumbers]);
}

void addDifference(const LensComparison::Number& number, double shown_sigma, LensRow& row) {
  constexpr double kFar = 3.0;
  row.difference = (number.difference < 0.0 ? "" : "+") + lensText(number.difference, shown_sigma);
  if (!(number.sigma > 0.0)) return;
  const double sigmas = std::abs(number.difference) / number.sigma;
  row.sigmas = QString::number(sigmas, 'f', 1);
  row.far = sigmas > kFar;
}

LensGroup numbersOf(const IntrinsicsResult& result, const std::optional<LensComparison>& compared) {
  const CameraIntrinsics& lens = result.intrinsics;
  LensGroup group{QObject::tr("%1, %2 x %3 px")
                      .arg(QString::fromUtf8(cameraModelTitle(lens.model)))
                      .arg(lens.resolution_px.width_px)
                      .arg(lens.resolution_px.height_px),
                  {}};
  std::array<double, kIntrinsicsCount> values{};
  writeIntrinsics(lens, values.data());
  const IntrinsicsVector sigmas = result.standardDeviations();
  const auto count = kPixelNumbers + static_cast<std::size_t>(distortionCount(lens));
  for (std::size_t k = 0; k < count; ++k) {
    const double sigma = sigmas[static_cast<Eigen::Index>(k)];
    LensRow row{lensNameOf(k, lens.model),
                lensText(values[k], sigma),
                sigmaText(sigma),
                k < kPixelNumbers ? "px" : "",
                {},
                {}};
    if (compared && compared->numbers) addDifference((*compared->numbers)[k], sigma, row);
    group.rows.push_back(row);
  }
  if (result.edge_localisation_bias_std_px > 0.0)
    group.rows.push_back({QObject::tr("Edge localisation bias"),
                          lensText(result.edge_localisation_bias_px, result.edge_localisation_bias_std_px),
                          sigmaText(result.edge_localisation_bias_std_px),
                          "px",
                          {},
                          {}});
  return group;
}

LensGroup fitOf(const IntrinsicsResult& result) {
  LensGroup group{QObject::tr("Accuracy"), {}};
  const auto add = [&](const QString& name, const QString& value, const QString& unit) {
    group.rows.push_back({name, value, {}, unit, {}, {}});
  };
  add(QObject::tr("Projection uncertainty, RMS"), pixels(result.image.rms_px), "px");
  add(QObject::tr("Projection uncertainty, at most"), pixels(result.image.max_px), "px");
  add(QObject::tr("Reprojection error, RMS"), pixels(result.reprojection_rms_px), "px");
  add(QObject::tr("Errors in units of their sigmas"), QString::number(result.normalised_rms, 'f', 2), {});
  return group;
}

LensGroup viewsOf(const NamedIntrinsics& named) {
  const IntrinsicsResult& result = named.result;
  const std::vector<IntrinsicsView>& views = named.story.views;
  LensGroup group{QObject::tr("Data"), {}};
  const auto add = [&](const QString& name, const QString& value, const QString& unit) {
    group.rows.push_back({name, value, {}, unit, {}, {}});
  };
  add(QObject::tr("Views used"), QObject::tr("%1 of %2").arg(result.views_used).arg(result.views_found), {});
  add(QObject::tr("Points used"), QString::number(result.circles_used), {});
  add(QObject::tr("Points excluded"), QString::number(result.circles_rejected), {});
  add(QObject::tr("Largest tilt of the board"), QString::number(result.largest_tilt_deg, 'f', 0), "deg");
  if (!views.empty()) {
    const auto [nearest, farthest] = std::minmax_element(
        views.begin(), views.end(), [](const auto& a, const auto& b) { return a.distance_m < b.distance_m; });
    add(QObject::tr("Board's distance"),
        QObject::tr("%1 to %2").arg(nearest->distance_m, 0, 'f', 2).arg(farthest->distance_m, 0, 'f', 2),
        "m");
  }
  add(QObject::tr("Passes over the recording"), QString::number(result.passes), {});
  if (result.moved_px > 0.0) add(QObject::tr("Change by the last pass"), pixels(result.moved_px), "px");
  return group;
}

}  // namespace

std::vector<LensGroup> lensGroups(const NamedIntrinsics& named,
                                  const std::optional<LensComparison>& compared) {
  std::vector<LensGroup> groups = {numbersOf(named.result, compared), fitOf(named.result), viewsOf(named)};
  if (std::vector<LensRow> tried = triedModels(named); tried.size() > 1)
    groups.push_back({QObject::tr("Lens models tried: errors in sigmas, fitted points"), std::move(tried)});
  return groups;
}

std::vector<LensRow> triedModels(const NamedIntrinsics& named) {
  std::vector<LensRow> rows;
  for (const TriedModel& tried : named.story.tried) {
    const QString title = QString::fromUtf8(cameraModelTitle(tried.model));
    LensRow row;
    row.name = tried.model == named.result.intrinsics.model ? QObject::tr("%1 (selected)").arg(title) : title;
    const double share = tried.circles > 0 ? 100.0 * tried.circles_used / tried.circles : 0.0;
    row.value = QObject::tr("%1, %2 %").arg(tried.spread_sigma, 0, 'f', 2).arg(share, 0, 'f', 0);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace evical::ui
