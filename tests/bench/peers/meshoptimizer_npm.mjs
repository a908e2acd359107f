// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The newest meshoptimizer, from npm, in the mode that moves vertices to where the error is least:
// meshoptimizer_npm.mjs BUILD_FOLDER INPUT.ply OUTPUT.ply RATIO
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import process from 'node:process';
import { pathToFileURL } from 'node:url';

const [build, input, output, ratio] = process.argv.slice(2);
const home = path.join(path.resolve(build), 'npm', 'node_modules', 'meshoptimizer');
const { MeshoptSimplifier } = await import(pathToFileURL(path.join(home, 'index.js')));
await MeshoptSimplifier.ready;

// Reads a file written by peer_clean.
function read(file) {
  const bytes = fs.readFileSync(file);
  const end = 'end_header\n';
  const start = bytes.indexOf(end) + end.length;
  const header = bytes.subarray(0, start).toString('latin1');
  const vertices = Number(/element vertex (\d+)/.exec(header)[1]);
  const faces = Number(/element face (\d+)/.exec(header)[1]);
  const width = /property double x/.test(header) ? 8 : 4;
  const positions = new Float32Array(3 * vertices);
  const colours = new Float32Array(/uchar red/.test(header) ? 3 * vertices : 0);
  let at = start;
  for (let v = 0; v < vertices; ++v) {
    for (let i = 3 * v; i < 3 * v + 3; ++i, at += width) {
      positions[i] = width === 8 ? bytes.readDoubleLE(at) : bytes.readFloatLE(at);
    }
    if (colours.length === 0) continue;
    for (let i = 3 * v; i < 3 * v + 3; ++i, ++at) colours[i] = bytes[at] / 255;
  }
  const indices = new Uint32Array(3 * faces);
  for (let i = 0; i < indices.length; ++i, at += 4) {
    if (i % 3 === 0) ++at; // the number of corners
    indices[i] = bytes.readUInt32LE(at);
  }
  return { positions, colours, indices };
}

function write(file, positions, colours, indices) {
  const renamed = new Map();
  for (const v of indices) if (!renamed.has(v)) renamed.set(v, renamed.size);
  const components = colours.length === 0 ? [] : ['red', 'green', 'blue'];
  const header = ['ply', 'format binary_little_endian 1.0', `element vertex ${renamed.size}`,
    'property float x', 'property float y', 'property float z',
    ...components.map((name) => `property uchar ${name}`), `element face ${indices.length / 3}`,
    'property list uchar uint vertex_indices', 'end_header', ''].join('\n');
  const body = Buffer.alloc(
    (12 + components.length) * renamed.size + 13 * (indices.length / 3));
  let at = 0;
  for (const v of renamed.keys()) {
    for (let axis = 0; axis < 3; ++axis) at = body.writeFloatLE(positions[3 * v + axis], at);
    components.forEach((_, i) => {
      const level = Math.round(255 * colours[3 * v + i]);
      at = body.writeUInt8(Math.min(Math.max(level, 0), 255), at);
    });
  }
  indices.forEach((v, i) => {
    if (i % 3 === 0) at = body.writeUInt8(3, at);
    at = body.writeUInt32LE(renamed.get(v), at);
  });
  fs.writeFileSync(file, Buffer.concat([Buffer.from(header, 'latin1'), body]));
}

const clean = `${output}.clean.ply`;
execFileSync(path.join(build, 'tests', 'bench', 'peer_clean'), [input, clean, '1']);
const { positions, colours, indices } = read(clean);
fs.unlinkSync(clean);
const target = 3 * Math.round(ratio * indices.length / 3);
const anyError = 3e38;
// Of the two weights tried, 0.01 and 0.05, the one with the closer colours.
const weights = colours.length === 0 ? [] : [0.05, 0.05, 0.05];
const before = process.cpuUsage();
const start = process.hrtime.bigint();
const [kept] = MeshoptSimplifier.simplifyWithUpdate(
  indices, positions, 3, colours, weights.length, weights, null, target, anyError);
const took = process.cpuUsage(before);
const wall = process.hrtime.bigint() - start;
write(output, positions, colours, indices.subarray(0, kept));
const { version } = JSON.parse(fs.readFileSync(path.join(home, 'package.json')));
console.log(JSON.stringify({ tool: 'meshoptimizer with update', version,
  cpu_s: (took.user + took.system) / 1e6, wall_s: Number(wall) / 1e9, triangles: kept / 3 }));
