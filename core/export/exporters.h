// One function per target, for the table of targets. Paths are relative to the target's folder.
#pragma once

#include "core/export/export_target.h"
#include "core/export/rig.h"

#include <string>
#include <vector>

namespace evical {

ExportedFiles exportKalibr(const NamedResult& result);
ExportedFiles exportOpenVins(const NamedResult& result);
ExportedFiles exportVinsFusion(const NamedResult& result);
ExportedFiles exportOrbSlam3(const NamedResult& result);
ExportedFiles exportBasalt(const NamedResult& result);
ExportedFiles exportRos(const NamedResult& result);
ExportedFiles exportSvo(const NamedResult& result);
ExportedFiles exportUltimateSlam(const NamedResult& result);
ExportedFiles exportEsvo(const NamedResult& result);
ExportedFiles exportEsvo2(const NamedResult& result);
ExportedFiles exportDvProcessing(const NamedResult& result);
ExportedFiles exportMetavision(const NamedResult& result);
ExportedFiles exportEkalibr(const NamedResult& result);
ExportedFiles exportKimera(const NamedResult& result);
ExportedFiles exportDmVio(const NamedResult& result);
ExportedFiles exportRtabmap(const NamedResult& result);
ExportedFiles exportOpenCv(const NamedResult& result);
ExportedFiles exportMatlab(const NamedResult& result);
ExportedFiles exportDsec(const NamedResult& result);
ExportedFiles exportM3ed(const NamedResult& result);
ExportedFiles exportEvimo2(const NamedResult& result);
ExportedFiles exportTumVie(const NamedResult& result);
ExportedFiles exportNumpy(const NamedResult& result);

// Basalt's calibration.json, which TUM-VIE also uses.

// Text for all cameras, in this order, with supported lens models. `more`: further members, each after a
// comma. Throws CalibrationError (BadInput) without an IMU.
std::string basaltCalibration(const Rig& rig, const char* program, ExportNotes& notes,
                              const std::string& more = {});

// Explanations of its keys.
std::vector<std::string> basaltMeanings(const RigImu& imu);

}  // namespace evical
