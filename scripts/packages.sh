#!/usr/bin/env bash
# Installs the Debian packages that building, testing and the demo need, where they are missing.
# With --fuzz also those of the fuzzers, with --lab those of tests/lab (Slurm, NFS and ssh servers,
# debootstrap: best on a machine of its own), with --lint those of lint.sh, with --npm npm.
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config make python3 dpkg-dev file groff-base
  libzmq3-dev cppzmq-dev libmetis-dev libboost-dev libboost-iostreams-dev
  libboost-program-options-dev doctest-dev libxxhash-dev libspdlog-dev libnanoflann-dev
  nlohmann-json3-dev libmeshoptimizer-dev zlib1g-dev libzstd-dev libpng-dev libturbojpeg0-dev
  libdraco-dev libcpp-httplib-dev)
for word in "$@"; do
  case "$word" in
    --fuzz) packages+=(clang libclang-rt-dev) ;;
    --lab) packages+=(user-mode-linux uml-utilities kmod nfs-common nfs-kernel-server rpcbind
      e2fsprogs iproute2 iptables openssh-server openssh-client strace
      slurm-wlm slurmctld slurmd slurm-client munge debootstrap) ;;
    --lint) packages+=(clang-format clang-tidy shellcheck) ;;
    --npm) command -v npm > /dev/null || packages+=(npm) ;;
    *) echo "packages.sh: unknown option $word" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2> /dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing: ${missing[*]}" >&2
sudo=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo > /dev/null || {
    echo "packages.sh: these packages are missing; install them as root: ${missing[*]}" >&2
    exit 1
  }
  sudo=(sudo)
fi
log=$(mktemp)
if ! { "${sudo[@]}" apt-get update && DEBIAN_FRONTEND=noninteractive \
       "${sudo[@]}" apt-get install -y --no-install-recommends "${missing[@]}"; } > "$log" 2>&1; then
  tail -n 5 "$log" >&2
  echo "packages.sh: could not install: ${missing[*]} (is this machine offline? see $log)" >&2
  exit 1
fi
rm -f "$log"
