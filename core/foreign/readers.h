// One reader per target, for the table of targets: reads the files in the target's folder like the program.
// Throws CalibrationError (BadInput) that names file and key if the program would refuse them.
#pragma once

#include "core/foreign/read_calibration.h"

namespace evical {

ReadBack readKalibr(const std::filesystem::path& folder);
ReadBack readOpenVins(const std::filesystem::path& folder);
ReadBack readVinsFusion(const std::filesystem::path& folder);
ReadBack readOrbSlam3(const std::filesystem::path& folder);
ReadBack readBasalt(const std::filesystem::path& folder);
ReadBack readRos(const std::filesystem::path& folder);
ReadBack readSvo(const std::filesystem::path& folder);
ReadBack readUltimateSlam(const std::filesystem::path& folder);
ReadBack readEsvo(const std::filesystem::path& folder);
ReadBack readEsvo2(const std::filesystem::path& folder);
ReadBack readDvProcessing(const std::filesystem::path& folder);
ReadBack readMetavision(const std::filesystem::path& folder);
ReadBack readEkalibr(const std::filesystem::path& folder);
ReadBack readKimera(const std::filesystem::path& folder);
ReadBack readDmVio(const std::filesystem::path& folder);
ReadBack readRtabmap(const std::filesystem::path& folder);
ReadBack readOpenCv(const std::filesystem::path& folder);
ReadBack readMatlab(const std::filesystem::path& folder);
ReadBack readDsec(const std::filesystem::path& folder);
ReadBack readM3ed(const std::filesystem::path& folder);
ReadBack readEvimo2(const std::filesystem::path& folder);
ReadBack readTumVie(const std::filesystem::path& folder);
ReadBack readNumpy(const std::filesystem::path& folder);

// Cameras of a single file, for import. Keys that only the other program requires may be missing.
ReadFile readBasaltFile(const std::filesystem::path& file);
ReadFile readDvProcessingFile(const std::filesystem::path& file);
ReadFile readVinsCameraFile(const std::filesystem::path& file);
ReadFile readOrbSlam3File(const std::filesystem::path& file);
ReadFile readSvoFile(const std::filesystem::path& file);
ReadFile readDsecFile(const std::filesystem::path& file);
ReadFile readEkalibrFile(const std::filesystem::path& file);
ReadFile readDsoCameraFile(const std::filesystem::path& file);
ReadFile readOpencvFile(const std::filesystem::path& file);

}  // namespace evical
