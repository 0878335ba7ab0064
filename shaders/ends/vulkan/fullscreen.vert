#version 450
// Vulkan: a triangle over the whole image, vkCmdDraw(buffer, 3, 1, 0, 0) with no attributes.

void main() {
    gl_Position = vec4(float(gl_VertexIndex & 1) * 4.0 - 1.0, float(gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0);
}
