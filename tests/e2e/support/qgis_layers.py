"""Opens collections and files with QGIS and prints what it sees as JSON.

  qgis_layers.py URL TOKEN COLLECTION… [FILE.tif…]

Needs Debian's packages python3-qgis and qgis-providers.
"""
import json
import os
import sys
import tempfile


def main(url, token, *names):
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    with tempfile.TemporaryDirectory() as profile:
        os.environ["QGIS_CUSTOM_CONFIG_PATH"] = profile
        os.environ["QGIS_AUTH_DB_DIR_PATH"] = profile
        # pylint: disable=import-outside-toplevel
        from qgis.core import (
            QgsApplication,
            QgsAuthMethodConfig,
            QgsRasterLayer,
            QgsVectorLayer,
            QgsWkbTypes,
        )

        application = QgsApplication([], False)
        application.initQgis()
        manager = QgsApplication.authManager()
        manager.setMasterPassword("of this profile only", True)
        account = QgsAuthMethodConfig("Basic")
        account.setName("Strata")
        account.setConfig("username", "owner")
        account.setConfig("password", token)
        manager.storeAuthenticationConfig(account)
        seen, layer, features = {}, None, None
        for name in names:
            if name.endswith(".tif"):
                layer = QgsRasterLayer(name, name)
                seen[os.path.basename(name)] = layer.isValid() and {
                    "crs": layer.crs().authid(),
                    "size": [layer.width(), layer.height()],
                    "nodata": layer.dataProvider().sourceNoDataValue(1),
                }
                continue
            source = f"url='{url}/ogc' typename='{name}' authcfg={account.id()}"
            layer = QgsVectorLayer(source, name, "OAPIF")
            features = list(layer.getFeatures()) if layer.isValid() else []
            seen[name] = layer.isValid() and {
                "crs": layer.crs().authid(),
                "kind": QgsWkbTypes.displayString(layer.wkbType()),
                "fields": [field.name() for field in layer.fields()],
                "count": len(features),
                "area": sum(feature.geometry().area() for feature in features),
            }
        print(json.dumps(seen), flush=True)
        # QGIS ends with an error if Python still refers to its objects.
        del layer, features
        application.exitQgis()


if __name__ == "__main__":
    main(*sys.argv[1:])
