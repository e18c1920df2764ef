# Debian's libjs-three, looked for again whenever it was not there. Only pages that show space need it, and say so.
find_path(KDS_THREE_FOLDER build/three.min.js
  PATHS /usr/share/javascript/three /usr/local/share/javascript/three
  DOC "Folder with build/three.min.js and examples/js/controls/OrbitControls.js")
set(KDS_THREE_DEFINITION "KDS_THREE_FOLDER=\"\"")
if(KDS_THREE_FOLDER)
  set(KDS_THREE_DEFINITION "KDS_THREE_FOLDER=\"${KDS_THREE_FOLDER}\"")
endif()
