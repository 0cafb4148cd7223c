# SPDX-License-Identifier: MIT
"""nginx as a cache server: files that may be put, as Bazel's manual sets it up."""
import os
import shutil
import socket
import subprocess
import time

PROGRAM = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin")
CONFIGURATION = """daemon off;
pid {folder}/nginx.pid;
error_log {folder}/nginx.log;
events {{ }}
http {{
    access_log off;
    server {{
        listen 127.0.0.1:{port};
        location / {{
            root {folder}/served;
            client_body_temp_path {folder}/served/tmp;
            dav_methods PUT;
            create_full_put_path on;
            client_max_body_size 1G;
        }}
    }}
}}
"""


def serve(folder):
    """The address of a server of the folder `served` in this one, and its process, which may have ended: then it does not start here."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    os.makedirs(os.path.join(folder, "served/tmp"))
    for place in ("", "served", "served/tmp"):
        os.chmod(os.path.join(folder, place), 0o777)
    configuration = os.path.join(folder, "nginx.conf")
    with open(configuration, "w", encoding="utf-8") as file:
        file.write(CONFIGURATION.format(folder=folder, port=port))
    process = subprocess.Popen([PROGRAM, "-p", folder, "-c", configuration], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    for _ in range(500):
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0 or process.poll() is not None:
                break
        time.sleep(0.01)
    return f"http://127.0.0.1:{port}", process
