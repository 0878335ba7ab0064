#version 450
// OpenGL 4.5: a triangle over the whole image, glDrawArrays(GL_TRIANGLES, 0, 3) with no attributes.

void main() {
    gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.5, 1.0);
}
