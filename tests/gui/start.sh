# Starts a screen and on it a Blender that has never been used before, which runs the story. Within a Debian of scripts/setup_window.
set -eu
export HOME=/home/me XDG_RUNTIME_DIR=/tmp/run LIBGL_ALWAYS_SOFTWARE=1 PYTHONDONTWRITEBYTECODE=1 DISPLAY=:52
mkdir -p "$HOME" "$XDG_RUNTIME_DIR"
chmod 700 "$XDG_RUNTIME_DIR"
Xvfb "$DISPLAY" -screen 0 1280x800x24 -nolisten tcp &
for _ in $(seq 100); do
    [ -S /tmp/.X11-unix/X52 ] && break
    sleep 0.1
done
status=0
blender --window-geometry 0 0 1280 800 --enable-event-simulate --python-exit-code 3 \
    --python /mnt/gui/run.py -- /mnt/out/zip/bonemesh.zip /mnt/out || status=$?
cp /tmp/*.crash.txt /mnt/out 2>/dev/null || true
exit $status
