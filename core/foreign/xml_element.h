// The part of XML that robot descriptions need: elements, their attributes and comments; no text.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace evical {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::string place;  // "rig.urdf: robot.joint (line 12)"

  std::vector<const XmlElement*> all(const std::string& name) const;  // children of this name
  // Both throw CalibrationError (BadInput) if it is missing.
  const XmlElement& one(const std::string& name) const;
  const std::string& attribute(const std::string& name) const;
};

// The document's root. Throws CalibrationError (BadInput) with the line of the error.
XmlElement readXml(const std::filesystem::path& file);

}  // namespace evical
