#!/bin/bash
# The entry of menus and its AppStream data are valid, as the tools of freedesktop.org read them.
#   menu_entry.sh SOURCE-FOLDER
set -eu
packaging=$1/cmake/packaging
for tool in desktop-file-validate:desktop-file-utils appstreamcli:appstream; do
  command -v "${tool%:*}" > /dev/null || {
    echo "skipped: there is no ${tool%:*}; apt-get install ${tool#*:}"
    exit 77
  }
done
desktop-file-validate "$packaging/org.photile.Photile.desktop"
appstreamcli validate --no-net "$packaging/org.photile.Photile.metainfo.xml"
