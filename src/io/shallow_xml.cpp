#include "io/shallow_xml.h"

#include <vtkObjectFactory.h>

namespace glisson::detail {

vtkStandardNewMacro(ShallowXml);

/// Before Parse() looks at the root element, which a tree that was broken off has not.
int ShallowXml::ParseXML() {
  const int parsed = Superclass::ParseXML();
  return too_deep_ ? 0 : parsed;
}

std::string ShallowXml::trouble(const VtkErrorLog& log) const {
  if (!too_deep_) return "it is no XML that VTK can read: " + log.first();
  return "its XML elements nest deeper than " + std::to_string(kDeepest) +
         " levels, and those of VTK's files do not: it is damaged, or no file of VTK";
}

void ShallowXml::StartElement(const char* name, const char** attributes) {
  too_deep_ = too_deep_ || ++depth_ > kDeepest;
  if (!too_deep_) Superclass::StartElement(name, attributes);
}

void ShallowXml::EndElement(const char* name) {
  if (too_deep_) return;
  --depth_;
  Superclass::EndElement(name);
}

int ShallowXml::ParsingComplete() { return too_deep_ ? 1 : Superclass::ParsingComplete(); }

}  // namespace glisson::detail
