// The part of XML that robot descriptions and OpenCV's files need: elements, their attributes, text and
// comments. A document type, which may name other files and define entities, is refused.
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
  std::string text;
  std::string place;  // "rig.urdf: robot.joint (line 12)"
  int line = 0;

  std::vector<const XmlElement*> all(const std::string& name) const;  // children of this name
  // Both throw CalibrationError (BadInput) if it is missing.
  const XmlElement& one(const std::string& name) const;
  const std::string& attribute(const std::string& name) const;
};

enum class XmlText { Refused, Kept };

// The document's root. Throws CalibrationError (BadInput) with the line of the error.
XmlElement readXml(const std::filesystem::path& file, XmlText text = XmlText::Refused);

}  // namespace evical
