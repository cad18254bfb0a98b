//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "none",
        "All faces are drawn.",
        "Only time is lost; see-through faces are blended in the order of the mesh.",
        "Vulkan: Basic Polygon Rasterization",
    ),
    Lesson::new(
        "back",
        "Faces that face away from the eye are culled by their winding.",
        "Right for closed meshes seen from outside; parts of open and mirrored meshes are missing, and of any mesh seen from inside.",
        "Foley and others 1990, Computer Graphics: Principles and Practice, 15.4",
    ),
    Lesson::new(
        "front",
        "Faces that face the eye are culled.",
        "Right only from inside a closed mesh.",
        "Vulkan: Basic Polygon Rasterization",
    ),
    Lesson::new(
        "back-flipped",
        "Back faces are culled, and the front face is switched if a transform mirrors.",
        "The program must know which transforms mirror.",
        "OpenGL 4.6: 14.6.1",
    ),
    Lesson::new(
        "front-then-back",
        "Back faces are blended first, then front faces.",
        "The right order for one convex solid; for several or hollow solids only a good guess.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "frustum",
        "Objects outside the view are not drawn.",
        "Nothing is lost as long as bounding volumes contain their objects.",
        "Clark 1976, Hierarchical Geometric Models for Visible Surface Algorithms",
    ),
];
