"""Self-signed certificates for servers with https."""
import os
import ssl
import subprocess


def make_certificate(folder, name, key_type="ec"):
    """Makes a self-signed certificate for 127.0.0.1. Returns (chain, key)."""
    chain, key = os.path.join(folder, name + ".pem"), os.path.join(folder, name + ".key")
    kind = ["ec", "-pkeyopt", "ec_paramgen_curve:P-256"] if key_type == "ec" else ["rsa:2048"]
    subprocess.run(
        [
            "openssl",
            "req",
            "-x509",
            "-newkey",
            *kind,
            "-nodes",
            "-days",
            "2",
            "-subj",
            f"/CN={name}",
            "-addext",
            "subjectAltName=IP:127.0.0.1",
            "-keyout",
            key,
            "-out",
            chain,
        ],
        check=True,
        capture_output=True,
    )
    return chain, key


def trusting(chain):
    return ssl.create_default_context(cafile=chain)
