// shallow_xml.h — VTK's XML parser with an end to how deep elements nest.
//
// VTK builds a tree of the elements and frees it by recursion, one call a level: 170 000 levels overflow a stack of 8 MB.
// Meshes and collections nest six levels deep.
#pragma once

#include <vtkXMLDataParser.h>

#include <string>

#include "io/vtk_log.h"

namespace glisson::detail {

/// Parse() gives 0 where elements nest deeper than kDeepest.
class ShallowXml : public vtkXMLDataParser {
 public:
  static ShallowXml* New();
  using Superclass = vtkXMLDataParser;

  static constexpr int kDeepest = 64;
  /// What was wrong with the text. @param log  that observed the parser
  std::string trouble(const VtkErrorLog& log) const;

 protected:
  int ParseXML() override;
  void StartElement(const char* name, const char** attributes) override;
  void EndElement(const char* name) override;
  int ParsingComplete() override;

 private:
  int depth_ = 0;
  bool too_deep_ = false;  ///< from here on elements are passed over
};

}  // namespace glisson::detail
